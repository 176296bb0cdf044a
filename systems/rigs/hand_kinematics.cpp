#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {

std::array<Pose, k_max_links> finger_link_frames(const FingerRig& finger,
                                                 const FingerAngles& angles) {
    std::array<Pose, k_max_links> frames;
    Pose at = finger.base_hs;
    at.rotation = rotation_about(finger.opposition_axis_hs, angles.opposition_rad) * at.rotation;
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        at.rotation = at.rotation * rotation_about(-Vec3::UnitX(), angles.curl_rad[link]);
        frames[link] = at;
        at.position = transform_point(at, Vec3(0.0, 0.0, -finger.length_m[link]));
    }
    return frames;
}

std::array<Vec3, k_max_links + 1> finger_points(const FingerRig& finger,
                                                const FingerAngles& angles) {
    const std::array<Pose, k_max_links> frames = finger_link_frames(finger, angles);
    std::array<Vec3, k_max_links + 1> points;
    points.fill(finger.base_hs.position);
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        points[link + 1] = transform_point(frames[link], Vec3(0.0, 0.0, -finger.length_m[link]));
    }
    return points;
}

FingerAngles angles_of_links(const FingerRig& finger, std::span<const Quat> rotations_hs) {
    FingerAngles angles;
    Quat at = finger.base_hs.rotation;
    const bool turns = finger.lower_opposition_rad < finger.upper_opposition_rad;
    if (turns && !rotations_hs.empty()) {
        // A curl does not change the hinge axis, so the hinge axis' turn about the opposition axis
        // is the opposition angle.
        const Vec3& axis = finger.opposition_axis_hs;
        const Vec3 from = at * Vec3::UnitX();
        const Vec3 to = rotations_hs[0] * Vec3::UnitX();
        const Vec3 from_flat = from - from.dot(axis) * axis;
        const Vec3 to_flat = to - to.dot(axis) * axis;
        angles.opposition_rad =
            arc_tangent2(axis.dot(from_flat.cross(to_flat)), from_flat.dot(to_flat));
        at = rotation_about(axis, angles.opposition_rad) * at;
    }
    for (std::size_t link = 0; link < finger.link_count && link < rotations_hs.size(); ++link) {
        const Vec3 along = at.conjugate() * (rotations_hs[link] * -Vec3::UnitZ());
        angles.curl_rad[link] = arc_tangent2(-along.y(), -along.z());
        at = at * rotation_about(-Vec3::UnitX(), angles.curl_rad[link]);
    }
    return angles;
}

FingerAngles coupled_angles(const FingerRig& finger, double share) {
    FingerAngles angles;
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        angles.curl_rad[link] =
            finger.lower_rad[link] + share * (finger.upper_rad[link] - finger.lower_rad[link]);
    }
    return angles;
}

FingerAngles relaxed_angles(const FingerRig& finger) {
    FingerAngles angles;
    angles.curl_rad = finger.rest_rad;
    return angles;
}

Pose mirror_hand_pose(const Pose& pose_hs) {
    const Quat& turn = pose_hs.rotation;
    return {Vec3(-pose_hs.position.x(), pose_hs.position.y(), pose_hs.position.z()),
            Quat(turn.w(), turn.x(), -turn.y(), -turn.z())};
}

HandRig mirror_hand_rig(const HandRig& rig) {
    HandRig mirrored = rig;
    mirrored.side = rig.side == HandSide::left ? HandSide::right : HandSide::left;
    for (FingerRig& finger : mirrored.fingers) {
        finger.base_hs = mirror_hand_pose(finger.base_hs);
        // Mirroring reverses the sense of a rotation, so the axis is mirrored and then negated.
        finger.opposition_axis_hs.y() *= -1.0;
        finger.opposition_axis_hs.z() *= -1.0;
    }
    for (PalmCapsule& capsule : mirrored.palm) {
        capsule.a_hs.x() *= -1.0;
        capsule.b_hs.x() *= -1.0;
    }
    mirrored.palm_center_hs.x() *= -1.0;
    mirrored.palm_normal_hs.x() *= -1.0;
    for (RigJoint& joint : mirrored.joints) {
        joint.joint_in_link = mirror_hand_pose(joint.joint_in_link);
    }
    return mirrored;
}

const char* finger_text(FingerName name) {
    constexpr std::array k_names = {"thumb", "index", "middle", "ring", "little"};
    return k_names[static_cast<std::size_t>(name)];
}

}  // namespace handhold
