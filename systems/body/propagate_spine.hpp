#pragma once

#include "components/arm.hpp"
#include "components/body_part.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/collision/surface_query.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PropagateSpineIo {
    double dt_s;                                 // in: > 0
    double t_s;                                  // in: the world's clock at the frame's end
    SurfaceQuery surfaces;                       // in: what trunk and legs touch; empty: nothing
    const Column<PersistentId>& persistent_id;   // in: a body ignores its own player's head
    const Column<PlayerOrigin>& origin;          // in
    const Column<PlayerVelocity>& velocity;      // in
    const Column<ReferenceVelocity>& reference;  // in
    const Column<HeadTracking>& head;            // in: pose_ps; shift_m is the floor's height
    const Column<BodyMeasures>& measures;        // in
    const Column<ArmEstimate>& estimate;         // in: the chest
    const Column<HandOwner>& owner;              // in: hands that pull the body
    const Column<Grab>& grab;           // in: hands that are not in this column hold nothing
    const Column<BodyHold>& body_hold;  // in: hands on other players' parts
    Column<SpineMemory>& memory;        // in/out
    Column<SpinePose>& pose;            // out; in: as shown in the last frame
};

inline constexpr double k_longest_spine_s = 0.5;

// Simulates spine and legs of every player as a chain of links: motion travels down from the chest,
// link by link. The chain advances in ticks at multiples of k_spine_tick_s (spine_chain.hpp) of the
// world clock, independent of the frame rate. Frames interpolate between the last two ticks.
//
// Two motions move the chain: the player's velocity relative to the reference velocity
// (ReferenceVelocity), and the chest's motion in play space as far as a bending neck does not cause
// it (ArmEstimate::from_neck_m). With the rest of it, and when the play space turns or a player is
// teleported, the chain moves along rigidly. If the chest jumps, the chain restarts from rest. At
// most k_longest_spine_s of a frame is simulated.
//
// Hanging: the trunk turns towards the opposite of the direction to the gripping hands
// (hang_body.hpp). Loose bodies in the hands pull nothing. Without a grip the trunk keeps its
// posture below the head, and an acceleration acts through the chain's inertia alone.
//
// Held by trunk or leg: the body moves rigidly with its player and does not trail. The grip's
// anchor is on the body: if a leg gave way to the pull, that would increase the pull.
//
// Contacts: trunk, thighs and shins stay in front of the first surface along each of them, seen
// from the head's side, and slide along it, within the joint limits (body_contacts.hpp). They apply
// no force to it.
//
// Crouching: the chain hangs straight in SpineMemory; pose_spine folds it above the tracked floor.
void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning);

}  // namespace handhold
