#pragma once

#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_rig.hpp"

// Distributes twist along arms, for figures whose forearm or upper arm has a single joint.
namespace handhold {

// Number of joints added to a bone, at one, two and three thirds of its length.
inline constexpr std::size_t k_arm_twists = 3;

// Distributes the hand's twist along each forearm, and the upper arm's twist against the chest
// along each upper arm; otherwise the skin would collapse at the wrist and at the shoulder. A bone
// whose skin follows a single joint gets joints named "<bone>_twist_1" and so on, in figure and
// rig. Each vertex is bound to the two joints between which it lies. If the bone's skin is rigid,
// adds no joints: the whole forearm takes half of the twist, and the upper arm all of its own.
// Changes nothing on a bone that has twist joints with skin, or if the figure would exceed
// k_max_skin_joints. Precondition: `rig` is fit_body_rig(figure).
void spread_arm_twist(SkinnedMesh& figure, BodyRig& rig);

}  // namespace handhold
