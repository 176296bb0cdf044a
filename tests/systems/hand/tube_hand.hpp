#pragma once

#include <array>
#include <numbers>
#include <string>

#include "components/hand_rig.hpp"
#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::test {

// The relaxed angles of all fingers.
inline std::array<FingerAngles, k_finger_count> relaxed(const HandRig& rig) {
    std::array<FingerAngles, k_finger_count> angles;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        angles[i] = relaxed_angles(rig.fingers[i]);
    }
    return angles;
}

// A skinned mesh of open tubes around a rig's links and palm capsules, posed at `angles` with the
// hand at `hand_ms`. A rig fitted to it has known capsules in closed form. Fingertip tubes end one
// radius beyond the tip, where the link's capsule ends.
inline SkinnedMesh make_tube_hand(const HandRig& rig,
                                  const std::array<FingerAngles, k_finger_count>& angles,
                                  const Pose& hand_ms) {
    SkinnedMesh skin;
    skin.file = "tubes";
    std::vector<std::array<Pose, k_max_links>> frames;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        frames.push_back(finger_link_frames(rig.fingers[i], angles[i]));
    }
    for (const RigJoint& joint : rig.joints) {
        const Pose in_hand =
            joint.finger == RigJoint::k_palm
                ? joint.joint_in_link
                : frames[static_cast<std::size_t>(joint.finger)][joint.link] * joint.joint_in_link;
        skin.joints.push_back({joint.name, -1, hand_ms * in_hand});
    }
    const auto joint_of = [&](std::int32_t finger, std::uint32_t link) {
        for (std::size_t i = 0; i < rig.joints.size(); ++i) {
            if (rig.joints[i].finger == finger && rig.joints[i].link == link) {
                return static_cast<std::uint16_t>(i);
            }
        }
        return std::uint16_t{0};
    };
    const auto add_tube = [&](const Vec3& a, const Vec3& b, double radius_m, std::uint16_t joint) {
        constexpr std::uint32_t k_around = 24;
        constexpr std::uint32_t k_rings = 12;
        const Quat turn = rotation_between(Vec3::UnitZ(), (b - a).normalized());
        const auto first = static_cast<std::uint32_t>(skin.positions.size());
        for (std::uint32_t ring = 0; ring <= k_rings; ++ring) {
            for (std::uint32_t k = 0; k < k_around; ++k) {
                double sine = 0.0;
                double cosine = 1.0;
                sin_cos(2.0 * std::numbers::pi * k / k_around, sine, cosine);
                const Vec3 out = turn * Vec3(cosine, sine, 0.0);
                const Vec3 at = a + (static_cast<double>(ring) / k_rings) * (b - a);
                skin.positions.push_back(transform_point(hand_ms, at + radius_m * out));
                skin.normals.push_back(hand_ms.rotation * out);
                skin.weights.push_back({{joint, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
                if (ring < k_rings) {
                    const std::uint32_t here = first + ring * k_around + k;
                    const std::uint32_t next = first + ring * k_around + (k + 1) % k_around;
                    skin.triangles.push_back({here, next, next + k_around});
                    skin.triangles.push_back({here, next + k_around, here + k_around});
                }
            }
        }
    };
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        const FingerRig& finger = rig.fingers[i];
        for (std::uint32_t link = 0; link < finger.link_count; ++link) {
            const bool is_last = link + 1 == finger.link_count;
            const double beyond_m = is_last ? finger.radius_m[link] : 0.0;
            const Pose& frame = frames[i][link];
            add_tube(frame.position,
                     transform_point(frame, Vec3(0, 0, -finger.length_m[link] - beyond_m)),
                     finger.radius_m[link], joint_of(static_cast<std::int32_t>(i), link));
        }
    }
    for (const PalmCapsule& capsule : rig.palm) {
        add_tube(capsule.a_hs, capsule.b_hs, capsule.radius_m, joint_of(RigJoint::k_palm, 0));
    }
    skin.color_runs.push_back({});
    return skin;
}

}  // namespace handhold::test
