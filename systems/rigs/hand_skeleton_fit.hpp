#pragma once

#include <optional>

#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

// The parts of fit_hand_rig: what its joints are, planar fingers through them, and what the skin
// tells of thickness.
namespace handhold {

// A finger's joints as the file has them, into SkinnedMesh::joints.
struct FingerBones {
    FingerName name = FingerName::index;
    std::optional<std::size_t> metacarpal;  // carried by the palm; a thumb's is a hinge instead
    std::vector<std::size_t> hinges;        // 2 or 3
    std::size_t tip = 0;
};
struct HandBones {
    std::size_t wrist = 0;
    std::vector<FingerBones> fingers;  // by FingerName
};
Result<HandBones> find_hand_bones(const SkinnedMesh& skin);

// Hand space in the file's frame; refused where the hand is of the other side, or of no hand's
// size.
Result<Pose> find_hand_frame(const SkinnedMesh& skin, const HandBones& bones, HandSide side);

// The finger through its joints' bind poses (hand space; hinges, then the tip), and its bind
// angles. Without radii.
FingerRig fit_finger(const FingerBones& bones, const std::vector<Vec3>& joints_hs, HandSide side,
                     FingerAngles& bind);

// Radii, the last links' lengths, the palm's capsules and centre, from the skin. `positions_hs`: of
// the skin's vertices, in hand space; the rig has its fingers and joints already.
void fit_hand_skin(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs, HandRigFit& fit);

}  // namespace handhold
