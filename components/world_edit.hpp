#pragma once

#include "components/world.hpp"

// Changes that a host makes between frames and that concern several columns at once. All throw
// PreconditionError, and change nothing, for an entity of another kind and for numbers outside
// world_limits.
namespace handhold {

// A kinematic body reaches `pose_ws` at the end of the next frame, with the velocity that takes it
// there, and then stays. Hands that grip it and bodies that it pushes move with it. Not for bodies
// with a mover.
void move_kinematic(World& world, Entity body, const Pose& pose_ws);

// Places a body at `pose_ws` at once, without collisions on the path. The body keeps its velocity.
// Hands that grip it let go.
void teleport_body(World& world, Entity body, const Pose& pose_ws);

// Places a player's play space at `origin_ws` at once, at rest relative to the scene. Free bodies
// in the player's hands that no joint holds come along; the hands let go of everything else. Hands
// of other players let go of this player's head and of bodies that come along.
void teleport_player(World& world, Entity player, const Pose& origin_ws);

// The player's hand on that side. Throws if there is no such player.
Entity hand_of(const World& world, Entity player, HandSide side);

}  // namespace handhold
