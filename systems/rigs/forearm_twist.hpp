#pragma once

#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_rig.hpp"

// Skin that twists along the forearm, for figures whose forearm is one joint.
namespace handhold {

// Joints added to a forearm, at thirds of its length.
inline constexpr std::size_t k_forearm_twists = 3;

// Where a forearm's skin all hangs on one joint, the wrist would be wrung by the whole twist of the
// hand: joints along the forearm are added to both, called as the forearm's with "_twist_1" and on,
// and each vertex goes with the two that it lies between. A forearm that is a rigid part takes half
// of the twist as a whole. Forearms that have joints for it, and carry skin with them, stay as they
// are. `rig` is fit_body_rig's of the figure. A figure with nearly k_max_skin_joints stays as it
// is.
void spread_forearm_twist(SkinnedMesh& figure, BodyRig& rig);

}  // namespace handhold
