#pragma once

#include <cstdint>
#include <string_view>

#include "components/arm.hpp"
#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/body_clip_state.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/render.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "engine/ecs/entity.hpp"

namespace handhold {

struct FrameClock {
    std::uint64_t frame = 0;  // frames stepped
    double t_s = 0.0;         // end of the last frame
};

// The whole state, and its table of contents: one column a component. Nothing outside of it
// survives a frame.
struct World {
    EntityPool entities;
    FrameClock clock;
    Vec3 reference_velocity_mps = Vec3::Zero();  // the scene's
    Column<PersistentId> persistent_id;          // every entity

    Column<RigidBody> body;
    Column<BodyPose> body_pose;            // every body
    Column<BodyStart> body_start;          // every body
    Column<BodyVelocity> body_velocity;    // every body
    Column<Collider> collider;             // bodies that can be touched; players: the head
    Column<Mover> mover;                   // kinematic bodies that move by themselves
    Column<PathMover> path_mover;          // kinematic bodies on closed paths
    Column<LegMover> leg_mover;            // bones of those bodies' legs
    Column<LastValidPose> last_valid;      // free bodies and players
    Column<AuthoredGrips> authored_grips;  // bodies that have some

    Column<Joint> joint;
    Column<JointState> joint_state;  // every joint

    Column<PlayerBody> player;
    Column<PlayerOrigin> player_origin;
    Column<PlayerStart> player_start;
    Column<PlayerVelocity> player_velocity;
    Column<PlayerCommands> player_commands;
    Column<ReferenceVelocity> reference_velocity;
    Column<HeadTracking> head_tracking;
    Column<HeadIgnores> head_ignores;
    Column<RenderPose> render_pose;
    Column<BodyMeasures> body_measures;  // these eight: every player
    Column<Calibration> calibration;
    Column<ArmMemory> arm_memory;
    Column<ArmEstimate> arm_estimate;
    Column<ArmPose> arm_pose;
    Column<SpineMemory> spine_memory;
    Column<SpinePose> spine_pose;
    Column<BodyClipState> body_clip_state;

    Column<HandOwner> hand_owner;
    Column<HandTracking> hand_tracking;
    Column<HandHistory> hand_history;
    Column<Grab> grab;
    Column<HandSight> hand_sight;
    Column<GripSurface> grip_surface;
    Column<PalmOffset> palm_offset;
    Column<PalmPose> palm_pose;
    Column<FingerPose> finger_pose;
    Column<ControllerToHand> controller_to_hand;  // only hands whose joint is not Tuning's
    Column<AuthoredHold> authored_hold;           // only hands that sit in an authored grip
    Column<HandPull> hand_pull;                   // only hands that pull something from afar
};

// Calls visit(name, column) for every column. The one list of them: hashing, destroying and
// snapshots follow it.
template <typename WorldType, typename Visit>
void visit_columns(WorldType& world, Visit&& visit) {
    visit("persistent_id", world.persistent_id);
    visit("body", world.body);
    visit("body_pose", world.body_pose);
    visit("body_start", world.body_start);
    visit("body_velocity", world.body_velocity);
    visit("collider", world.collider);
    visit("mover", world.mover);
    visit("path_mover", world.path_mover);
    visit("leg_mover", world.leg_mover);
    visit("last_valid", world.last_valid);
    visit("authored_grips", world.authored_grips);
    visit("joint", world.joint);
    visit("joint_state", world.joint_state);
    visit("player", world.player);
    visit("player_origin", world.player_origin);
    visit("player_start", world.player_start);
    visit("player_velocity", world.player_velocity);
    visit("player_commands", world.player_commands);
    visit("reference_velocity", world.reference_velocity);
    visit("head_tracking", world.head_tracking);
    visit("head_ignores", world.head_ignores);
    visit("render_pose", world.render_pose);
    visit("body_measures", world.body_measures);
    visit("calibration", world.calibration);
    visit("arm_memory", world.arm_memory);
    visit("arm_estimate", world.arm_estimate);
    visit("arm_pose", world.arm_pose);
    visit("spine_memory", world.spine_memory);
    visit("spine_pose", world.spine_pose);
    visit("body_clip_state", world.body_clip_state);
    visit("hand_owner", world.hand_owner);
    visit("hand_tracking", world.hand_tracking);
    visit("hand_history", world.hand_history);
    visit("grab", world.grab);
    visit("hand_sight", world.hand_sight);
    visit("grip_surface", world.grip_surface);
    visit("palm_offset", world.palm_offset);
    visit("palm_pose", world.palm_pose);
    visit("finger_pose", world.finger_pose);
    visit("controller_to_hand", world.controller_to_hand);
    visit("authored_hold", world.authored_hold);
    visit("hand_pull", world.hand_pull);
}

struct BodyDescription {
    std::string_view name;  // unique in the world: gives the persistent id
    RigidBody body;
    Pose pose_ws;
    BodyVelocity velocity;
    ShapeId shape;
};
// A body, and its collider unless its shape is k_no_shape. Throws PreconditionError for a name that
// is taken, a pose that is not valid, or a free body without mass or inertia.
Entity add_body(World& world, const BodyDescription& description);

struct JointDescription {
    std::string_view name;  // unique in the world
    Joint joint;
};
// A joint between two bodies, or the world and one. Throws PreconditionError for a name that is
// taken, a body that is none, a frame that is not valid, limits the wrong way round, or a negative
// friction, detent or latch.
Entity add_joint(World& world, const JointDescription& description);
// The joint whose frames meet at `frame_ws` as the two bodies stand now; kind and all numbers as in
// `joint`.
Joint joint_at(const World& world, Joint joint, const Pose& frame_ws);

struct PlayerDescription {
    std::string_view name;  // unique in the world
    PlayerBody body;
    Pose origin_ws;
    Vec3 velocity_mps = Vec3::Zero();
    ShapeId head_shape;  // a sphere
    BodyMeasures measures = {};
};
struct PlayerEntities {
    Entity player;
    Entity hands[k_hand_count];  // by HandSide
};
// A player and his two hands. Errors as add_body.
PlayerEntities add_player(World& world, const PlayerDescription& description);

// Removes the entity from every column; a player's hands go with him, and a body's joints with it.
// False for a stale handle.
bool destroy(World& world, Entity entity);

// Null where no entity has the id.
Entity find_by_id(const World& world, PersistentId id);

}  // namespace handhold
