#pragma once

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/collision/surface_query.hpp"
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
    // In: for contacts of the legs. Set `surfaces` and the two columns below it, or none of the
    // three.
    SurfaceQuery surfaces = {};  // in
    // In: rays start in the head; shift_m is the floor's height.
    const Column<HeadTracking>* head = nullptr;
    // In: so that legs ignore their own player.
    const Column<PersistentId>* persistent_id = nullptr;
};

// Stage 14. Simulates spine and legs of every player as a chain of links: motion travels down from
// the chest, link by link. The chain advances in ticks at multiples of 1/120 s of the world clock,
// independent of the frame rate. Frames interpolate between the last two ticks.
//
// Two motions move the chain: the player's velocity relative to the reference velocity
// (ReferenceVelocity), and the chest's motion in play space. When the play space turns or a player
// is teleported, the chain moves along rigidly. If the chest jumps, the chain restarts from rest.
// At most 0.5 s of a frame is simulated.
//
// Contacts: knees and soles stay on the head's side of the first surface between head and sole, and
// slide along that surface, within the joint limits. They apply no force to it. Each leg queries
// surfaces 15 times a second; between queries the surface moves with the reference velocity. Clips
// are added later and ignore surfaces.
//
// Crouching: the chain hangs straight in SpineMemory; pose_spine folds it above the tracked floor.
void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning);

}  // namespace handhold
