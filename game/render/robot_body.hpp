#pragma once

#include <string>

#include "engine/geometry/mesh.hpp"
#include "engine/io/gltf_skin.hpp"

// The robot that represents the player, without its hands (robot_hand.hpp). It is a figure in
// T-pose, posed and drawn like a loaded figure.
namespace handhold {

// The bytes of a .glb, identical each time: shells, joints and lamps, each rigid on one joint, for
// an eye height of 1.64 m. Opens in animation software; parse_gltf_figure and fit_body_rig read it.
std::string make_robot_body_glb();
// The same, parsed.
SkinnedMesh make_robot_body();

}  // namespace handhold
