#pragma once

#include <vector>

#include "components/hand_rig.hpp"
#include "game/render/figure_kit.hpp"

// The robot's hand over a rig: each part is rigid, on one link or on the palm.
namespace handhold {

struct HandPart {
    std::int32_t finger = RigJoint::k_palm;  // into HandRig::fingers, or k_palm
    std::uint32_t link = 0;
    FigureMaterial material = FigureMaterial::shell;
    Mesh mesh;  // in the link's frame, or in hand space
};

// Shells, pads and hinges after the rig's lengths and radii, for any number of fingers and links;
// pads are flush with the rig's capsules, nothing stands out of them by more than a millimetre on
// the palm's side. A left rig gives the mirrored parts of its right one.
std::vector<HandPart> make_robot_hand(const HandRig& rig);

// The parts of one: for pictures of hands that are posed part by part. The palm in hand space,
// right hands only; a link along -Z from its hinge.
FigureKit build_robot_palm(const HandRig& right_rig);
FigureKit build_robot_link(double length_m, double radius_m, bool is_first, bool is_last);

}  // namespace handhold
