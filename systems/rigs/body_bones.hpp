#pragma once

#include <array>
#include <optional>

#include "systems/rigs/body_rig_fit.hpp"

// The first step of fit_body_rig: which joint is which bone.
namespace handhold {

using SideBones = std::array<std::optional<std::size_t>, k_body_bone_count>;
// Which joint is which bone, into SkinnedMesh::joints.
struct BodyBones {
    SideBones middle;
    std::array<SideBones, k_hand_count> sides;

    std::optional<std::size_t>& at(const BodyJointName& name) {
        SideBones& side = is_limb(name.bone) ? sides[index_of(name.side)] : middle;
        return side[static_cast<std::size_t>(name.bone)];
    }
    const std::optional<std::size_t>& limb(HandSide side, BodyBone bone) const {
        return sides[index_of(side)][static_cast<std::size_t>(bone)];
    }
    const std::optional<std::size_t>& of_middle(BodyBone bone) const {
        return middle[static_cast<std::size_t>(bone)];
    }
};

// By names; what a map says goes before. Refused as fit_body_rig says.
Result<BodyBones> find_body_bones(const SkinnedMesh& figure, const BodyMap& map);

inline const Vec3& place_of(const SkinnedMesh& figure, std::size_t joint) {
    return figure.joints[joint].bind_ms.position;
}
bool is_below(const SkinnedMesh& figure, std::size_t joint, std::size_t above);

}  // namespace handhold
