#pragma once

#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_rig.hpp"

// Distributes the hand's twist along the forearm, for figures whose forearm has a single joint.
namespace handhold {

// Number of joints added to a forearm, at one, two and three thirds of its length.
inline constexpr std::size_t k_forearm_twists = 3;

// Distributes the hand's twist along each forearm whose skin follows a single joint; otherwise the
// skin would collapse at the wrist. Adds joints named "<forearm>_twist_1" and so on to figure and
// rig, and binds each vertex to the two joints between which it lies. If the forearm's skin is
// rigid, adds no joints: the whole forearm takes half of the twist. Changes nothing if the forearm
// has twist joints with skin, or if the figure would exceed k_max_skin_joints. Precondition: `rig`
// is fit_body_rig(figure).
void spread_forearm_twist(SkinnedMesh& figure, BodyRig& rig);

}  // namespace handhold
