#include "systems/rigs/arm_twist.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace handhold {
namespace {

constexpr float k_no_weight = 1e-3F;

double weight_of(const SkinWeights& weights, std::size_t joint) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.joint.size(); ++i) {
        sum += weights.joint[i] == joint && weights.weight[i] > k_no_weight
                   ? static_cast<double>(weights.weight[i])
                   : 0.0;
    }
    return sum;
}

bool carries_skin(const SkinnedMesh& figure, std::size_t joint) {
    return std::any_of(
        figure.weights.begin(), figure.weights.end(),
        [joint](const SkinWeights& weights) { return weight_of(weights, joint) > 0.0; });
}

// Finds the joint of a bone that carries its skin. Returns false if several joints along the bone
// do, or none.
bool find_single_joint(const SkinnedMesh& figure, const BodyRig& rig, BodyBone bone, HandSide side,
                       std::size_t& joint) {
    bool is_found = false;
    for (std::size_t i = 0; i < rig.joints.size(); ++i) {
        const BodyRig::Carrier& carrier = rig.carriers[rig.joints[i].carrier];
        if (carrier.bone != bone || carrier.side != side || !carries_skin(figure, i)) {
            continue;
        }
        const bool is_along = bone == BodyBone::forearm && carrier.along > 0.0;
        if (is_found || is_along) {
            return false;
        }
        joint = i;
        is_found = true;
    }
    return is_found;
}

// True if no vertex follows both this joint and another one.
bool is_rigid(const SkinnedMesh& figure, std::size_t joint) {
    constexpr double k_all = 0.999;
    return std::none_of(figure.weights.begin(), figure.weights.end(),
                        [joint](const SkinWeights& weights) {
                            const double weight = weight_of(weights, joint);
                            return weight > 0.0 && weight < k_all;
                        });
}

// Indices of the bone's joint and of the added joints, along the bone.
using TwistJoints = std::array<std::uint16_t, k_arm_twists + 1>;

// Adds up the joint's weights in one slot of the vertex and returns that slot.
std::size_t gather_weight(std::size_t joint, SkinWeights& weights) {
    const auto sum = static_cast<float>(weight_of(weights, joint));
    std::size_t slot = weights.joint.size();
    for (std::size_t i = weights.joint.size(); i-- > 0;) {
        if (weights.joint[i] == joint && weights.weight[i] > k_no_weight) {
            weights.weight[i] = 0.0F;
            slot = i;
        }
    }
    weights.weight[slot] = sum;
    return slot;
}

// Distributes a vertex's weight on the bone's joint to the two joints between which the vertex
// lies. If the vertex has no free slot for the second joint, the nearer one gets all of it.
void share_out(const TwistJoints& joints, double along, SkinWeights& weights) {
    const double place = std::clamp(along, 0.0, 1.0) * static_cast<double>(k_arm_twists);
    const auto below = std::min(static_cast<std::size_t>(place), k_arm_twists - 1);
    const auto share = static_cast<float>(place - static_cast<double>(below));
    const std::size_t slot = gather_weight(joints[0], weights);
    const auto* const free = std::find_if(weights.weight.begin(), weights.weight.end(),
                                          [](float weight) { return weight <= k_no_weight; });
    if (free == weights.weight.end()) {
        weights.joint[slot] = joints[share < 0.5F ? below : below + 1];
        return;
    }
    const auto other = static_cast<std::size_t>(free - weights.weight.begin());
    weights.joint[other] = joints[below + 1];
    weights.weight[other] = share * weights.weight[slot];
    weights.joint[slot] = joints[below];
    weights.weight[slot] *= 1.0F - share;
}

void add_joints(std::size_t joint, SkinnedMesh& figure, BodyRig& rig) {
    const BodyRig::Carrier bone = rig.carriers[rig.joints[joint].carrier];
    rig.carriers[rig.joints[joint].carrier].along = 0.0;
    TwistJoints joints{static_cast<std::uint16_t>(joint)};
    for (std::size_t i = 1; i <= k_arm_twists; ++i) {
        BodyRig::Carrier carrier = bone;
        carrier.along = static_cast<double>(i) / static_cast<double>(k_arm_twists);
        joints[i] = static_cast<std::uint16_t>(rig.joints.size());
        const std::string name = rig.joints[joint].name + "_twist_" + std::to_string(i);
        const Pose in_bone{Vec3(0.0, 0.0, -carrier.along * carrier.length_m), Quat::Identity()};
        const Pose bind_ms = carrier.rest_ms * in_bone;
        const auto parent = static_cast<std::int32_t>(joint);
        rig.joints.push_back({name, parent, bind_ms, rig.carriers.size(), in_bone});
        figure.joints.push_back({name, parent, bind_ms, {}});
        rig.carriers.push_back(carrier);
    }
    for (std::size_t i = 0; i < figure.positions.size(); ++i) {
        if (weight_of(figure.weights[i], joint) > 0.0) {
            const Vec3 at = inverse_transform_point(bone.rest_ms, figure.positions[i]);
            share_out(joints, -at.z() / bone.length_m, figure.weights[i]);
        }
    }
}

}  // namespace

void spread_arm_twist(SkinnedMesh& figure, BodyRig& rig) {
    constexpr double k_rigid_share = 0.5;
    for (const BodyBone bone : {BodyBone::upper_arm, BodyBone::forearm}) {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            std::size_t joint = 0;
            if (!find_single_joint(figure, rig, bone, side, joint)) {
                continue;
            }
            if (!is_rigid(figure, joint)) {
                if (figure.joints.size() + k_arm_twists <= k_max_skin_joints) {
                    add_joints(joint, figure, rig);
                }
            } else if (bone == BodyBone::forearm) {
                rig.carriers[rig.joints[joint].carrier].along = k_rigid_share;
            }
        }
    }
}

}  // namespace handhold
