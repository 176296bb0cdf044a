#pragma once

#include <optional>
#include <span>
#include <vector>

#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

// The steps of fit_hand_rig: finds the joints, fits the fingers as planar chains, and measures the
// skin.
namespace handhold {

// A finger's joints, as indices into SkinnedMesh::joints.
struct FingerBones {
    FingerName name = FingerName::index;
    // Belongs to the palm; a thumb's metacarpal may be its first hinge instead.
    std::optional<std::size_t> metacarpal;
    std::vector<std::size_t> hinges;  // 2 or 3 joints
    std::size_t tip = 0;
};
struct HandBones {
    std::size_t wrist = 0;
    std::vector<FingerBones> fingers;  // fingers in the order of FingerName
};
Result<HandBones> find_hand_bones(const SkinnedMesh& skin);

// A finger's first hinge, in any frame.
struct Knuckle {
    FingerName name = FingerName::index;
    Vec3 place = Vec3::Zero();
};
// Finds the axes of hand space in the frame of wrist and knuckles, in metres: turned so that the
// knuckles lie like those of the built-in hand with the same fingers. `knuckles` are in the order
// of FingerName. None if there are fewer than two, or if they are in line with the wrist.
std::optional<Quat> find_hand_axes(const Vec3& wrist, std::span<const Knuckle> knuckles,
                                   HandSide side);
// Finds a finger's hinge axis from its joints' positions (at least two, no two in one place): a
// compromise between perpendicular to the bones and the usual axis. Unit length, in hand space.
Vec3 find_hinge_axis(FingerName name, const std::vector<Vec3>& joints_hs, HandSide side);

// Finds the pose of hand space in the file's frame. Errors: hands of the other side or of
// implausible size, and bones that are too short.
Result<Pose> find_hand_frame(const SkinnedMesh& skin, const HandBones& bones, HandSide side);

// Fits a finger to its joints' positions (`joints_hs`: hinges, then the tip) and writes its bind
// angles. Leaves the radii 0.
FingerRig fit_finger(const FingerBones& bones, const std::vector<Vec3>& joints_hs, HandSide side,
                     FingerAngles& bind);

// Measures radii, lengths of the last links, and the palm's capsules and centre from the skin.
// `positions_hs`: the skin's vertices in hand space. Precondition: fit.rig has its fingers and
// joints.
void fit_hand_skin(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs, HandRigFit& fit);

}  // namespace handhold
