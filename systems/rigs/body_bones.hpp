#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_joint_names.hpp"
#include "systems/rigs/body_map.hpp"
#include "systems/rigs/hand_joint_names.hpp"

// First step of fit_body_rig: finds the joint of each bone.
namespace handhold {

using SideBones = std::array<std::optional<std::size_t>, k_body_bone_count>;
// Joints of a hand's fingers that the map names, by FingerName and HandBone.
using SideFingers =
    std::array<std::array<std::optional<std::size_t>, k_hand_bone_count>, k_finger_count>;
// The joint of each bone, as an index into SkinnedMesh::joints. `middle` holds trunk, neck and
// head.
struct BodyBones {
    SideBones middle;
    std::array<SideBones, k_hand_count> sides;
    std::array<SideFingers, k_hand_count> fingers = {};

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

// Finds the joints that a map names.
Result<BodyBones> find_mapped_bones(const SkinnedMesh& figure, const BodyMap& map);

// Finds the bones: those in `mapped`, then by the joints' names, then by shape
// (fill_bones_by_shape). If the result is not plausible, repeats this without the names. Returns
// the errors that fit_body_rig lists. `names`: the caller's means of naming joints, for the
// message.
Result<BodyBones> find_body_bones(const SkinnedMesh& figure, const BodyBones& mapped,
                                  const char* names = "a map");

// Finds the missing bones from the joints' hierarchy and positions: feet are lowest, hands farthest
// to the sides, the head above the arms, and elbows and knees in the middle of their limbs. Changes
// no known bone. Leaves a bone empty if it cannot be determined.
void fill_bones_by_shape(const SkinnedMesh& figure, BodyBones& bones);

// Describes the first implausible proportion of a figure with these bones, with the names of the
// joints. Returns none if all proportions are plausible. Precondition: `bones` has head, upper
// arms, forearms and hands.
std::optional<std::string> find_implausible_bone(const SkinnedMesh& figure, const BodyBones& bones);

inline const Vec3& place_of(const SkinnedMesh& figure, std::size_t joint) {
    return figure.joints[joint].bind_ms.position;
}
bool is_below(const SkinnedMesh& figure, std::size_t joint, std::size_t above);

// Returns the prefix that most joints' names share, up to a separator: "Shinobi_" of
// "Shinobi_Arm_L". It names the figure, so it must not be read as part of a bone's name. Empty if
// there is none.
std::string shared_name_prefix(const SkinnedMesh& figure);
inline std::string_view bare_name(std::string_view name, std::string_view prefix) {
    return name.substr(name.starts_with(prefix) ? prefix.size() : 0);
}

// The joints of a figure as a tree.
class JointTree {
  public:
    explicit JointTree(const SkinnedMesh& figure);

    const std::vector<std::size_t>& children(std::size_t joint) const { return children_[joint]; }
    std::size_t depth(std::size_t joint) const { return depth_[joint]; }
    // Number of joints below this one.
    std::size_t size(std::size_t joint) const { return size_[joint]; }
    // Sum of all vertices' skin weights on this joint (skin), and on this joint and all joints
    // below it (skin_below).
    double skin(std::size_t joint) const { return skin_[joint]; }
    double skin_below(std::size_t joint) const { return skin_below_[joint]; }
    // Joints from the root to this joint, including both.
    std::vector<std::size_t> path_to(std::size_t joint) const;

  private:
    const SkinnedMesh* figure_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> depth_, size_;
    std::vector<double> skin_, skin_below_;
};

}  // namespace handhold
