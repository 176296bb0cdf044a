#pragma once

#include <string>

#include "engine/geometry/mesh.hpp"
#include "engine/io/gltf_skin.hpp"

// The robot that the player is, without its hands (robot_hand.hpp): a figure in T-pose like any
// other, so that the game poses and draws it as it does loaded ones.
namespace handhold {

// The bytes of a .glb, equal each time: shells, joints and lamps, each rigid on one joint, for a
// player whose eyes are at 1.64 m. Opens in animation packages; parse_gltf_figure and fit_body_rig
// read it.
std::string make_robot_body_glb();
// The same, read.
SkinnedMesh make_robot_body();

}  // namespace handhold
