#include "systems/rigs/hand_rig_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_skeleton_fit.hpp"

namespace handhold {
namespace {

// Attaches a finger's joints to its links, so that the bind angles reproduce the poses in the file.
void add_finger_joints(const SkinnedMesh& skin, const FingerBones& bones, const Pose& to_hand,
                       HandRigFit& fit) {
    const std::size_t place = fit.rig.fingers.size() - 1;
    const std::array<Pose, k_max_links> frames =
        finger_link_frames(fit.rig.fingers[place], fit.bind[place]);
    const auto add = [&](std::size_t joint, std::uint32_t link) {
        fit.rig.joints[joint].finger = static_cast<std::int32_t>(place);
        fit.rig.joints[joint].link = link;
        fit.rig.joints[joint].joint_in_link =
            inverse(frames[link]) * (to_hand * skin.joints[joint].bind_ms);
    };
    for (std::uint32_t link = 0; link < bones.hinges.size(); ++link) {
        add(bones.hinges[link], link);
    }
    add(bones.tip, static_cast<std::uint32_t>(bones.hinges.size()) - 1);
}

// Attaches other joints below a finger's joint (such as a nail or a twist joint) to the same link.
void carry_other_joints(const SkinnedMesh& skin, HandRigFit& fit) {
    std::vector<RigJoint>& joints = fit.rig.joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        std::int32_t above = static_cast<std::int32_t>(i);
        while (above != -1 && joints[static_cast<std::size_t>(above)].finger == RigJoint::k_palm) {
            above = skin.joints[static_cast<std::size_t>(above)].parent;
        }
        if (above == -1 || above == static_cast<std::int32_t>(i)) {
            continue;
        }
        const RigJoint& carrier = joints[static_cast<std::size_t>(above)];
        const std::size_t place = static_cast<std::size_t>(carrier.finger);
        joints[i].finger = carrier.finger;
        joints[i].link = carrier.link;
        joints[i].joint_in_link =
            inverse(finger_link_frames(fit.rig.fingers[place], fit.bind[place])[carrier.link]) *
            joints[i].joint_in_link;
    }
}

const std::vector<double>* find_numbers(const SkinJoint& joint, const char* key) {
    const auto found = joint.numbers.find(key);
    return found == joint.numbers.end() ? nullptr : &found->second;
}

// Takes the palm's sizes from the file, if it has them. Returns false if they are invalid.
bool take_palm(const SkinJoint& wrist, HandRig& rig) {
    constexpr double k_max_m = 1.0;
    const auto is_good = [](double number) { return std::abs(number) <= k_max_m; };
    if (const auto* center = find_numbers(wrist, k_palm_center_key)) {
        if (center->size() != 3 || !std::all_of(center->begin(), center->end(), is_good)) {
            return false;
        }
        rig.palm_center_hs = Vec3((*center)[0], (*center)[1], (*center)[2]);
    }
    if (const auto* list = find_numbers(wrist, k_palm_capsules_key)) {
        if (list->size() % 7 != 0 || list->size() > 7 * k_max_palm_capsules ||
            !std::all_of(list->begin(), list->end(), is_good)) {
            return false;
        }
        rig.palm.clear();
        for (std::size_t i = 0; i < list->size(); i += 7) {
            const double* const n = list->data() + i;
            if (!(n[6] > 0.0)) {
                return false;
            }
            rig.palm.push_back({Vec3(n[0], n[1], n[2]), Vec3(n[3], n[4], n[5]), n[6]});
        }
    }
    return true;
}

// Takes a link's size from the file, if it has one. Returns false if it is invalid.
bool take_link(const SkinJoint& joint, const char* key, double low, double high, double& value) {
    const auto* numbers = find_numbers(joint, key);
    if (numbers == nullptr) {
        return true;
    }
    if (numbers->size() != 1 || !((*numbers)[0] >= low && (*numbers)[0] <= high)) {
        return false;
    }
    value = (*numbers)[0];
    return true;
}

// Replaces measured sizes by those in the file. Returns an error if they are invalid.
std::optional<FileError> take_own_numbers(const SkinnedMesh& skin, const HandBones& bones,
                                          HandRig& rig) {
    const auto refuse = [&](std::size_t joint) {
        return FileError{skin.file, "/skins",
                         "expected a hand's sizes in the extras of \"" + skin.joints[joint].name +
                             "\", found others"};
    };
    for (std::size_t i = 0; i < bones.fingers.size(); ++i) {
        for (std::size_t link = 0; link < bones.fingers[i].hinges.size(); ++link) {
            const std::size_t joint = bones.fingers[i].hinges[link];
            if (!take_link(skin.joints[joint], k_link_radius_key, 1e-3, 0.1,
                           rig.fingers[i].radius_m[link]) ||
                !take_link(skin.joints[joint], k_link_length_key, 1e-3, 0.5,
                           rig.fingers[i].length_m[link])) {
                return refuse(joint);
            }
        }
    }
    if (!take_palm(skin.joints[bones.wrist], rig)) {
        return refuse(bones.wrist);
    }
    return std::nullopt;
}

}  // namespace

Result<HandRigFit> fit_hand_rig(const SkinnedMesh& skin, HandSide side) {
    const Result<HandBones> bones = find_hand_bones(skin);
    if (!bones) {
        return bones.error();
    }
    const Result<Pose> hand = find_hand_frame(skin, bones.value(), side);
    if (!hand) {
        return hand.error();
    }
    HandRigFit fit;
    fit.hand_ms = hand.value();
    fit.rig.side = side;
    const Pose to_hand = inverse(fit.hand_ms);
    for (const SkinJoint& joint : skin.joints) {  // attaches all joints to the palm first
        fit.rig.joints.push_back({joint.name, RigJoint::k_palm, 0, to_hand * joint.bind_ms});
    }
    for (const FingerBones& finger : bones.value().fingers) {
        std::vector<Vec3> joints_hs;
        for (const std::size_t hinge : finger.hinges) {
            joints_hs.push_back(transform_point(to_hand, skin.joints[hinge].bind_ms.position));
        }
        joints_hs.push_back(transform_point(to_hand, skin.joints[finger.tip].bind_ms.position));
        fit.rig.fingers.push_back(
            fit_finger(finger, joints_hs, side, fit.bind[fit.rig.fingers.size()]));
        add_finger_joints(skin, finger, to_hand, fit);
    }
    carry_other_joints(skin, fit);
    std::vector<Vec3> positions_hs;
    positions_hs.reserve(skin.positions.size());
    for (const Vec3& position : skin.positions) {
        positions_hs.push_back(transform_point(to_hand, position));
    }
    fit_hand_skin(skin, positions_hs, fit);
    if (std::optional<FileError> error = take_own_numbers(skin, bones.value(), fit.rig)) {
        return *std::move(error);
    }
    return fit;
}

Result<HandRig> hand_rig_from_skin(const SkinnedMesh& skin, HandSide side) {
    Result<HandRigFit> fit = fit_hand_rig(skin, side);
    if (!fit) {
        return fit.error();
    }
    return std::move(fit.value().rig);
}

}  // namespace handhold
