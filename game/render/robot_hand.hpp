#pragma once

#include <vector>

#include "components/hand_rig.hpp"
#include "game/render/figure_kit.hpp"

// The robot's hand, built for a rig. Each part is rigid, on one link or on the palm.
namespace handhold {

struct HandPart {
    std::int32_t finger = RigJoint::k_palm;  // index in HandRig::fingers, or k_palm
    std::uint32_t link = 0;
    FigureMaterial material = FigureMaterial::shell;
    Mesh mesh;  // mesh in the link's frame; parts of the palm: in hand space
    // Part of the cuff behind the wrist: turns about it with the forearm, if there is one.
    bool is_cuff = false;
};

// Builds shells, pads and hinges for the rig's lengths and radii, for any number of fingers and
// links. Pads are flush with the rig's capsules. On the palm's side nothing protrudes by more than
// a millimetre. The parts of a left rig mirror those of the right rig.
std::vector<HandPart> make_robot_hand(const HandRig& rig);

// Parts of one palm or link, for pictures of hands that are posed part by part. The palm is in hand
// space (right hands only); a link extends along -Z from its hinge.
FigureKit build_robot_palm(const HandRig& right_rig);
FigureKit build_robot_cuff();  // cuff in hand space, for both hands
FigureKit build_robot_link(double length_m, double radius_m, bool is_first, bool is_last);

}  // namespace handhold
