#pragma once

#include <optional>

#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

// The parts of fit_hand_rig: finding the joints, fitting planar fingers, and measuring the skin.
namespace handhold {

// A finger's joints, as indices into SkinnedMesh::joints.
struct FingerBones {
    FingerName name = FingerName::index;
    std::optional<std::size_t> metacarpal;  // part of the palm; a thumb's is a hinge instead
    std::vector<std::size_t> hinges;        // 2 or 3
    std::size_t tip = 0;
};
struct HandBones {
    std::size_t wrist = 0;
    std::vector<FingerBones> fingers;  // by FingerName
};
Result<HandBones> find_hand_bones(const SkinnedMesh& skin);

// Hand space in the file's frame. Refuses hands of the other side and of implausible size.
Result<Pose> find_hand_frame(const SkinnedMesh& skin, const HandBones& bones, HandSide side);

// Fits a finger through its joints' positions (hand space; hinges, then the tip) and writes its
// bind angles. Leaves the radii 0.
FingerRig fit_finger(const FingerBones& bones, const std::vector<Vec3>& joints_hs, HandSide side,
                     FingerAngles& bind);

// Measures radii, the last links' lengths, and the palm's capsules and centre from the skin.
// `positions_hs`: the skin's vertices in hand space. Requires the rig's fingers and joints.
void fit_hand_skin(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs, HandRigFit& fit);

}  // namespace handhold
