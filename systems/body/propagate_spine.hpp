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
    // What legs touch: all three, or none and they touch nothing.
    const CollisionWorld* collision = nullptr;            // in
    const Column<HeadTracking>* head = nullptr;           // in: before all surfaces
    const Column<PersistentId>* persistent_id = nullptr;  // in: nobody's legs touch his own head
};

// Stage 14. Spine and legs of every player: momentum snakes down from the chest, link by link.
// Ticks at every 120th of a second of the world's clock, whatever the frames are; between two of
// them what is shown goes on linearly, a tick late. Only velocities
// count, against the reference velocity, and the chest's own motion in play space: turning the play
// space, and whatever puts a player elsewhere, takes the chain along unmoved. Where the chest jumps
// the chain starts at rest. Of a frame longer than half a second only half a second is played.
// Knees and soles stay on the head's side of the surface that the line from the head to the sole
// meets, and slide along it, as far as their limits let them; they push nothing, and the player not
// at all. Each leg looks 15 times a second; what it found stays where it is against the reference.
// Clips lie on top and see no surfaces.
void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning);

}  // namespace handhold
