// Skeletons that hosts give as arrays (hh_player_set_body_skeleton).
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "systems/host/host_skeleton.hpp"
#include "systems/rigs/body_bones.hpp"
#include "systems/rigs/body_rig_fit.hpp"

namespace handhold {
namespace {

std::string text_of_joint(std::span<const hh_skeleton_joint> joints, std::size_t joint) {
    const char* const name = joints[joint].name;
    const std::string index = "joint " + std::to_string(joint);
    return name == nullptr ? index : index + " (" + name + ")";
}

// The bone of a body that an hh_body_joint is; none for joints of the spine, which need no bone.
std::optional<BodyJointName> bone_of(std::int32_t joint) {
    constexpr std::array k_arm = {BodyBone::clavicle, BodyBone::upper_arm, BodyBone::forearm,
                                  BodyBone::hand};
    constexpr std::array k_leg = {BodyBone::thigh, BodyBone::shin, BodyBone::foot};
    const auto limb = [&](const auto& bones, std::int32_t left) {
        const auto at = static_cast<std::size_t>(joint - left);
        return BodyJointName{bones[at % bones.size()],
                             at < bones.size() ? HandSide::left : HandSide::right};
    };
    if (joint >= HH_LEFT_UPPER_LEG) {
        return limb(k_leg, HH_LEFT_UPPER_LEG);
    }
    if (joint >= HH_LEFT_SHOULDER) {
        return limb(k_arm, HH_LEFT_SHOULDER);
    }
    switch (joint) {
        case HH_HIPS:
            return BodyJointName{BodyBone::trunk, HandSide::left};
        case HH_NECK:
            return BodyJointName{BodyBone::neck, HandSide::left};
        case HH_HEAD:
            return BodyJointName{BodyBone::head, HandSide::left};
        default:
            return std::nullopt;
    }
}

// Where the map keeps what `is` says; null: the joint needs no bone.
std::optional<std::size_t>* slot_of(BodyBones& bones, std::int32_t is) {
    if (is < HH_IS_LEFT_HAND) {
        const auto bone = bone_of(is - HH_IS_BODY);
        return bone ? &bones.at(*bone) : nullptr;
    }
    const HandSide side = is < HH_IS_RIGHT_HAND ? HandSide::left : HandSide::right;
    const auto joint = static_cast<std::size_t>(
        is - (side == HandSide::left ? HH_IS_LEFT_HAND : HH_IS_RIGHT_HAND));
    if (joint == HH_HAND_WRIST) {
        return &bones.at({BodyBone::hand, side});
    }
    if (joint < HH_THUMB_METACARPAL) {
        return nullptr;
    }
    const FingerName finger = finger_of_hand_joint(joint);
    std::size_t bone = 0;
    while (hand_joint_index(finger, static_cast<HandBone>(bone)) != joint) {
        ++bone;
    }
    return &bones.fingers[index_of(side)][static_cast<std::size_t>(finger)][bone];
}

bool is_known(std::int32_t is) {
    const auto is_within = [is](std::int32_t from, std::int32_t count) {
        return is >= from && is < from + count;
    };
    return is == HH_IS_BY_NAME || is_within(HH_IS_BODY, HH_BODY_JOINT_COUNT) ||
           is_within(HH_IS_LEFT_HAND, HH_HAND_JOINT_COUNT) ||
           is_within(HH_IS_RIGHT_HAND, HH_HAND_JOINT_COUNT);
}

BodyBones read_map(std::span<const hh_skeleton_joint> joints) {
    BodyBones bones;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        require(is_known(joints[i].is), HH_ERROR_VALUE,
                [&] { return text_of_joint(joints, i) + ": `is` is no joint"; });
        std::optional<std::size_t>* const slot =
            joints[i].is == HH_IS_BY_NAME ? nullptr : slot_of(bones, joints[i].is);
        if (slot != nullptr) {
            require(!slot->has_value(), HH_ERROR_VALUE,
                    [&] { return text_of_joint(joints, i) + ": another joint is the same one"; });
            *slot = i;
        }
    }
    return bones;
}

// World poses of joints given in their parents, whatever their order.
void compose(std::span<const hh_skeleton_joint> joints, SkinnedMesh& figure) {
    std::vector<bool> is_done(joints.size(), false);
    std::vector<std::size_t> path;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        path.clear();
        for (auto at = static_cast<std::int32_t>(i);
             at >= 0 && !is_done[static_cast<std::size_t>(at)];
             at = joints[static_cast<std::size_t>(at)].parent) {
            path.push_back(static_cast<std::size_t>(at));
        }
        for (; !path.empty(); path.pop_back()) {
            SkinJoint& joint = figure.joints[path.back()];
            if (joint.parent >= 0) {
                joint.bind_ms =
                    figure.joints[static_cast<std::size_t>(joint.parent)].bind_ms * joint.bind_ms;
            }
            is_done[path.back()] = true;
        }
    }
}

SkinnedMesh read_figure(std::span<const hh_skeleton_joint> joints, hh_space space) {
    SkinnedMesh figure;
    figure.file = "skeleton";
    const auto count = static_cast<std::int32_t>(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
        require(joints[i].parent >= -1 && joints[i].parent < count, HH_ERROR_VALUE,
                [&] { return text_of_joint(joints, i) + ": no joint has its parent's index"; });
        const std::string name =
            joints[i].name == nullptr ? "joint " + std::to_string(i) : joints[i].name;
        figure.joints.push_back({name, joints[i].parent, checked(joints[i].bind), {}});
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        std::int32_t at = joints[i].parent;
        for (std::int32_t steps = 0; at >= 0; ++steps) {
            require(steps < count, HH_ERROR_VALUE,
                    [&] { return text_of_joint(joints, i) + ": its parents form a ring"; });
            at = joints[static_cast<std::size_t>(at)].parent;
        }
    }
    if (space == HH_SPACE_PARENT) {
        compose(joints, figure);
    }
    // What stands for the skin, by which eyes and soles are found: a vertex at every joint.
    for (std::size_t i = 0; i < joints.size(); ++i) {
        figure.positions.push_back(figure.joints[i].bind_ms.position);
        figure.weights.push_back({{static_cast<std::uint16_t>(i), 0, 0, 0}, {1.0F, 0, 0, 0}});
    }
    return figure;
}

}  // namespace

BodyRig fit_skeleton(std::span<const hh_skeleton_joint> joints, hh_space space) {
    require(space == HH_SPACE_WORLD || space == HH_SPACE_PARENT, HH_ERROR_VALUE,
            "a space is HH_SPACE_WORLD or HH_SPACE_PARENT");
    const SkinnedMesh figure = read_figure(joints, space);
    Result<BodyRig> rig = fit_body_rig_with(figure, read_map(joints), "hh_skeleton_joint.is");
    if (!rig) {
        throw HostError{HH_ERROR_DATA, "skeleton: " + rig.error().expected};
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        rig.value().joints[i].name = joints[i].name == nullptr ? "" : joints[i].name;
    }
    return std::move(rig.value());
}

}  // namespace handhold
