#pragma once

#include <array>
#include <optional>
#include <vector>

#include "systems/rigs/body_rig_fit.hpp"

// The first step of fit_body_rig: which joint is which bone.
namespace handhold {

using SideBones = std::array<std::optional<std::size_t>, k_body_bone_count>;
// Joints of bones, as indices into SkinnedMesh::joints.
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

// Takes what the map says, then what names say, then fills what is missing by shape
// (fill_bones_by_shape). If the result is not plausible, tries the shape without the names. Refuses
// as fit_body_rig does.
Result<BodyBones> find_body_bones(const SkinnedMesh& figure, const BodyMap& map);

// Finds the missing bones from the hierarchy and the joints' places: feet end lowest, hands end
// farthest to the sides, the head is above the arms, and elbows and knees halve their limbs.
// Changes no bone that is known. Leaves out what it cannot tell.
void fill_bones_by_shape(const SkinnedMesh& figure, BodyBones& bones);

// The implausible proportions of a figure posed by these bones, with the names of its
// joints; nothing if it is a plausible body. Requires head, upper arms, forearms and hands.
std::optional<std::string> find_implausible_bone(const SkinnedMesh& figure, const BodyBones& bones);

inline const Vec3& place_of(const SkinnedMesh& figure, std::size_t joint) {
    return figure.joints[joint].bind_ms.position;
}
bool is_below(const SkinnedMesh& figure, std::size_t joint, std::size_t above);

// The joints of a figure as a tree.
class JointTree {
  public:
    explicit JointTree(const SkinnedMesh& figure);

    const std::vector<std::size_t>& children(std::size_t joint) const { return children_[joint]; }
    std::size_t depth(std::size_t joint) const { return depth_[joint]; }
    // Joints below this one.
    std::size_t size(std::size_t joint) const { return size_[joint]; }
    // Sum of the weights with which vertices follow this joint alone, and it and all below it.
    double skin(std::size_t joint) const { return skin_[joint]; }
    double skin_below(std::size_t joint) const { return skin_below_[joint]; }
    // From the root to the joint, both included.
    std::vector<std::size_t> path_to(std::size_t joint) const;

  private:
    const SkinnedMesh* figure_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> depth_, size_;
    std::vector<double> skin_, skin_below_;
};

}  // namespace handhold
