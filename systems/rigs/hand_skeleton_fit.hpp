#pragma once

#include <optional>

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
    std::vector<std::size_t> hinges;  // 2 or 3
    std::size_t tip = 0;
};
struct HandBones {
    std::size_t wrist = 0;
    std::vector<FingerBones> fingers;  // fingers in the order of FingerName
};
Result<HandBones> find_hand_bones(const SkinnedMesh& skin);

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
