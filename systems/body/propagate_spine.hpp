#pragma once

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PropagateSpineIo {
    double dt_s = 0.0;                           // in: > 0
    double t_s = 0.0;                            // in: the world's clock at the frame's end
    const Column<PlayerOrigin>& origin;          // in
    const Column<PlayerVelocity>& velocity;      // in
    const Column<ReferenceVelocity>& reference;  // in
    const Column<BodyMeasures>& measures;        // in
    const Column<ArmEstimate>& estimate;         // in: the chest
    Column<SpineMemory>& memory;                 // in/out
    Column<SpinePose>& pose;                     // out
    // For contacts of the legs: `collision` and the two columns below it, or none of them.
    const CollisionWorld* collision = nullptr;            // in
    const Column<HeadTracking>* head = nullptr;           // in: rays start here; the floor's shift
    const Column<PersistentId>* persistent_id = nullptr;  // in: legs ignore their own player
};

// Stage 14. Simulates spine and legs of every player: motion travels down from the chest, link by
// link. The chain advances in ticks at multiples of 1/120 s of the world clock, independent of the
// frame rate; frames interpolate between the last two ticks.
//
// Only velocities relative to the reference velocity and the chest's own motion in play space move
// the chain. Turning the play space or teleporting a player carries the chain along. If the chest
// jumps, the chain restarts from rest. At most 0.5 s of a frame is simulated.
//
// Contacts: knees and soles stay on the head's side of the first surface between head and sole, and
// slide along it, within their joint limits. They apply no force. Each leg queries surfaces 15
// times a second; in between the surface keeps its place relative to the reference. Clips are added
// later and ignore surfaces.
//
// Crouching: the chain hangs straight in SpineMemory; pose_spine folds it above the tracked floor.
void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning);

}  // namespace handhold
