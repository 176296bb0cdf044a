#pragma once

#include <string>

#include "engine/geometry/mesh.hpp"
#include "engine/io/gltf_skin.hpp"

// The robot that represents the player, without its hands (robot_hand.hpp). It is a figure in
// T-pose, which is posed and drawn like a loaded figure.
namespace handhold {

// The bytes of a .glb, the same on every call. Each part (shells, joint covers, lamps) is bound to
// one joint. Eye height: 1.64 m. Animation software can open the file; parse_gltf_figure and
// fit_body_rig can read it.
std::string make_robot_body_glb();
// The figure of make_robot_body_glb, parsed.
SkinnedMesh make_robot_body();

}  // namespace handhold
