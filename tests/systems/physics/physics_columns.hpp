#pragma once

#include "engine/collision/collision_world.hpp"
#include "systems/physics/build_constraints.hpp"
#include "systems/physics/place_colliders.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::test {

// The columns that place_colliders and build_constraints read, empty, and both systems.
struct PhysicsColumns {
    Column<PersistentId> persistent_id;
    Column<Collider> collider;
    Column<CollisionFilter> filter;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    Column<BodyStart> body_start;
    Column<BodyVelocity> body_velocity;
    Column<LastValidPose> last_valid;
    Column<Joint> joint;
    Column<JointState> joint_state;
    Column<PlayerBody> player;
    Column<PlayerOrigin> origin;
    Column<PlayerStart> player_start;
    Column<PlayerVelocity> player_velocity;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    FrameGraph frame;
    Tuning tuning;

    void place_colliders(CollisionWorld& collision) {
        handhold::place_colliders({.persistent_id = persistent_id,
                                   .collider = collider,
                                   .filter = filter,
                                   .body = body,
                                   .body_pose = body_pose,
                                   .body_start = body_start,
                                   .body_velocity = body_velocity,
                                   .origin = origin,
                                   .player_start = player_start,
                                   .head = head,
                                   .last_valid = last_valid,
                                   .collision = collision,
                                   .frame = frame},
                                  tuning.head);
    }
    void build_constraints() {
        handhold::build_constraints({.dt_s = 1.0 / 90.0,
                                     .persistent_id = persistent_id,
                                     .body = body,
                                     .body_pose = body_pose,
                                     .body_velocity = body_velocity,
                                     .joint = joint,
                                     .joint_state = joint_state,
                                     .player = player,
                                     .origin = origin,
                                     .player_velocity = player_velocity,
                                     .head = head,
                                     .owner = owner,
                                     .grab = grab,
                                     .body_hold = body_hold,
                                     .frame = frame},
                                    tuning);
    }
};

}  // namespace handhold::test
