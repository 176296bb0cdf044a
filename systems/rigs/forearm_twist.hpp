#pragma once

#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_rig.hpp"

// Twist distribution for figures whose forearm is one joint.
namespace handhold {

// Joints added to a forearm, at thirds of its length.
inline constexpr std::size_t k_forearm_twists = 3;

// Distributes the hand's twist along each forearm whose skin follows a single joint; the wrist
// would otherwise collapse. Adds joints named "<forearm>_twist_1" and so on to figure and rig, and
// binds each vertex to the two joints between which it lies. A rigid forearm takes half of the
// twist as a whole. Changes nothing if the forearm has twist joints with skin, or if the figure
// would exceed k_max_skin_joints. `rig` comes from fit_body_rig of this figure.
void spread_forearm_twist(SkinnedMesh& figure, BodyRig& rig);

}  // namespace handhold
