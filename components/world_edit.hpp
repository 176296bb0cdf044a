#pragma once

#include "components/world.hpp"

// Changes that a host makes between frames and that concern several columns at once. All throw
// PreconditionError, and change nothing, for an entity of another kind and for numbers outside
// world_limits.
namespace handhold {

// A kinematic body reaches `pose_ws` at the end of the next frame and then stays. Hands that grip
// it and bodies that it pushes move with it. Its velocity is measured over its last moves: see
// animate_movers. Not for bodies with a mover.
void move_kinematic(World& world, Entity body, const Pose& pose_ws);

// Places a body at `pose_ws` at once, without collisions on the path. The body keeps its velocity.
// Hands that grip it let go.
void teleport_body(World& world, Entity body, const Pose& pose_ws);

// A body gets another kind, mass, inertia, friction and restitution. A body that becomes fixed or
// kinematic stops; one that becomes free keeps its velocity. Movers and targets of a body that is
// no longer kinematic are gone. Grips stay: see follow_changed_bodies in update_grabs.cpp.
void change_body(World& world, Entity entity, const RigidBody& body);

// A body gets another shape, or none (k_no_shape). `frame`: the new shape's frame in the old one,
// so the body's pose becomes pose * frame. Grips, joints, authored grips and velocities stay where
// they are in the world. Palms and fingers look for the surface again. A body with a mover keeps
// its frame: `frame` is the identity.
void change_shape(World& world, Entity body, ShapeId shape, const Pose& frame);

// Hands on the body look for its surface again, because what GripSurface and FingerPose name are
// triangles of another mesh. For hosts that give a body another surface without change_shape.
void forget_surface(World& world, Entity body);

// Places a player's play space at `origin_ws` at once, at rest relative to the scene. Free bodies
// in the player's hands that no joint holds come along; the hands let go of everything else. Hands
// of other players let go of this player and of the bodies that come along.
void teleport_player(World& world, Entity player, const Pose& origin_ws);

// Returns the player's hand on that side. Throws if there is no such player.
Entity hand_of(const World& world, Entity player, HandSide side);

}  // namespace handhold
