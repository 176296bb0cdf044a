#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "components/arm.hpp"
#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/body_clip_state.hpp"
#include "components/body_part.hpp"
#include "components/calibration.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/render.hpp"
#include "components/size_estimate.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "components/world_index.hpp"
#include "engine/ecs/column.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/geometry/shape_library.hpp"

namespace handhold {

struct FrameClock {
    std::uint64_t frame = 0;  // number of frames stepped
    double t_s = 0.0;         // end of the last frame, s
};

// The whole state: one column per component. No other state is kept from frame to frame.
struct World {
    EntityPool entities;
    FrameClock clock;
    // Velocity of the scene in the world; see ReferenceVelocity.
    Vec3 reference_velocity_mps = Vec3::Zero();
    Vec3 gravity_mps2 = Vec3::Zero();    // gravity on free bodies, world space; players float
    Column<PersistentId> persistent_id;  // every entity

    Column<RigidBody> body;
    Column<BodyPose> body_pose;            // every body
    Column<BodyStart> body_start;          // every body
    Column<BodyVelocity> body_velocity;    // every body
    Column<Collider> collider;             // bodies with a shape; players: the sphere of the head
    Column<Mover> mover;                   // kinematic bodies with constant velocities
    Column<PathMover> path_mover;          // kinematic bodies on closed paths
    Column<LegMover> leg_mover;            // kinematic bones of crawling legs
    Column<MoveTarget> move_target;        // kinematic bodies that a host moves
    Column<GravityScale> gravity_scale;    // bodies whose scale is not 1
    Column<CollisionFilter> filter;        // bodies and players with layers of their own
    Column<GrabRule> grab_rule;            // bodies that not every hand may grip
    Column<LastValidPose> last_valid;      // free bodies and players
    Column<AuthoredGrips> authored_grips;  // bodies with authored grips

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
    Column<BodyMeasures> body_measures;  // every player has this and the next eight components
    Column<Calibration> calibration;
    Column<SizeEstimate> size_estimate;
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
    // Only hands with a controller-to-hand pose of their own; other hands use HandTuning.
    Column<ControllerToHand> controller_to_hand;
    Column<AuthoredHold> authored_hold;    // only hands in an authored grip
    Column<BodyHold> body_hold;            // only hands on another player's arm, trunk or leg
    Column<HandPull> hand_pull;            // only hands that pull a body from a distance
    Column<EarlySamples> early_samples;    // only players with samples later than the last frame
    Column<RecenterGuess> recenter_guess;  // only players whose host announces recentrings
    Column<GrabLayers> grab_layers;        // only players whose hands do not grip everything
    Column<GrabOrder> grab_order;          // only hands with an order for the next frame
    Column<HandRigChoice> hand_rig;        // only hands with a rig of their own

    // Caches of persistent_id and joint, maintained by the functions below. Not state.
    EntityById entity_by_id;
    JointsByBody joints_by_body;
    std::unordered_map<std::uint64_t, std::string> name_of_id;  // indexed by persistent id
};

// Columns of two kinds. Shown columns are what the shown stages write and what only they read:
// fitted hands, arms, spine, legs and the poses that hosts draw. All other columns are simulated:
// without the shown stages, and whatever is in the shown columns, they change equally, bit for bit.
template <typename Component>
inline constexpr bool k_is_shown = false;
template <>
inline constexpr bool k_is_shown<RenderPose> = true;
template <>
inline constexpr bool k_is_shown<ArmMemory> = true;
template <>
inline constexpr bool k_is_shown<ArmEstimate> = true;
template <>
inline constexpr bool k_is_shown<ArmPose> = true;
template <>
inline constexpr bool k_is_shown<SpineMemory> = true;
template <>
inline constexpr bool k_is_shown<SpinePose> = true;
template <>
inline constexpr bool k_is_shown<BodyClipState> = true;
template <>
inline constexpr bool k_is_shown<GripSurface> = true;
template <>
inline constexpr bool k_is_shown<PalmOffset> = true;
template <>
inline constexpr bool k_is_shown<PalmPose> = true;
template <>
inline constexpr bool k_is_shown<FingerPose> = true;

// Calls visit(name, &World::column) for every column. Hashing, snapshots and destroy use this list.
template <typename Visit>
void visit_column_members(Visit&& visit) {
    visit("persistent_id", &World::persistent_id);
    visit("body", &World::body);
    visit("body_pose", &World::body_pose);
    visit("body_start", &World::body_start);
    visit("body_velocity", &World::body_velocity);
    visit("collider", &World::collider);
    visit("mover", &World::mover);
    visit("path_mover", &World::path_mover);
    visit("leg_mover", &World::leg_mover);
    visit("move_target", &World::move_target);
    visit("gravity_scale", &World::gravity_scale);
    visit("filter", &World::filter);
    visit("grab_rule", &World::grab_rule);
    visit("last_valid", &World::last_valid);
    visit("authored_grips", &World::authored_grips);
    visit("joint", &World::joint);
    visit("joint_state", &World::joint_state);
    visit("player", &World::player);
    visit("player_origin", &World::player_origin);
    visit("player_start", &World::player_start);
    visit("player_velocity", &World::player_velocity);
    visit("player_commands", &World::player_commands);
    visit("reference_velocity", &World::reference_velocity);
    visit("head_tracking", &World::head_tracking);
    visit("head_ignores", &World::head_ignores);
    visit("render_pose", &World::render_pose);
    visit("body_measures", &World::body_measures);
    visit("calibration", &World::calibration);
    visit("size_estimate", &World::size_estimate);
    visit("arm_memory", &World::arm_memory);
    visit("arm_estimate", &World::arm_estimate);
    visit("arm_pose", &World::arm_pose);
    visit("spine_memory", &World::spine_memory);
    visit("spine_pose", &World::spine_pose);
    visit("body_clip_state", &World::body_clip_state);
    visit("hand_owner", &World::hand_owner);
    visit("hand_tracking", &World::hand_tracking);
    visit("hand_history", &World::hand_history);
    visit("grab", &World::grab);
    visit("hand_sight", &World::hand_sight);
    visit("grip_surface", &World::grip_surface);
    visit("palm_offset", &World::palm_offset);
    visit("palm_pose", &World::palm_pose);
    visit("finger_pose", &World::finger_pose);
    visit("controller_to_hand", &World::controller_to_hand);
    visit("authored_hold", &World::authored_hold);
    visit("body_hold", &World::body_hold);
    visit("hand_pull", &World::hand_pull);
    visit("early_samples", &World::early_samples);
    visit("recenter_guess", &World::recenter_guess);
    visit("grab_layers", &World::grab_layers);
    visit("grab_order", &World::grab_order);
    visit("hand_rig", &World::hand_rig);
}
// Calls visit(name, column) for every column of a world.
template <typename WorldType, typename Visit>
void visit_columns(WorldType& world, Visit&& visit) {
    visit_column_members([&](const char* name, auto member) { visit(name, world.*member); });
}
// Calls visit(name, &World::column) for every simulated column.
template <typename Visit>
void visit_simulated_members(Visit&& visit) {
    visit_column_members([&](const char* name, auto member) {
        using Elements = std::remove_cvref_t<decltype(std::declval<World&>().*member)>;
        if constexpr (!k_is_shown<typename Elements::Element>) {
            visit(name, member);
        }
    });
}

// Limits of the numbers that add_body, add_joint and add_player accept. Within these limits, no
// frame computes a number that a snapshot refuses.
namespace world_limits {
constexpr double k_max_coordinate_m = 1e9;  // limit of each axis
constexpr double k_max_speed_mps = 1e6;
constexpr double k_max_spin_radps = 1e4;
constexpr double k_max_gravity_mps2 = 1e4;  // limit of each axis
constexpr double k_min_mass_kg = 1e-12;
constexpr double k_max_mass_kg = 1e15;
constexpr double k_min_inertia_kgm2 = 1e-24;
constexpr double k_max_inertia_kgm2 = 1e18;
constexpr double k_max_friction = 1e6;          // RigidBody::friction
constexpr double k_max_joint_coordinate = 1e9;  // rad or m
constexpr double k_max_joint_strength = 1e15;   // N or N m
}  // namespace world_limits

struct BodyDescription {
    std::string_view name;  // unique in the world; hashed to the persistent id
    RigidBody body;
    Pose pose_ws;
    BodyVelocity velocity;
    ShapeId shape;
};
// Adds a body. The body gets a collider unless its shape is k_no_shape. Throws PreconditionError,
// and adds nothing, for: a duplicate name; a number outside world_limits; a restitution outside [0,
// 1]; a free body without mass or inertia.
Entity add_body(World& world, const BodyDescription& description);
// Also throws for a shape that is not in the library, and for a free body whose shape is a mesh.
// The overload without a library cannot check this; the first frame throws instead.
Entity add_body(World& world, const BodyDescription& description, const ShapeLibrary& shapes);

// Throws PreconditionError, with the caller's name, for numbers that add_body refuses.
void check_rigid_body(const RigidBody& body, const char* caller);

struct JointDescription {
    std::string_view name;  // unique in the world
    Joint joint;
};
// Throws PreconditionError for limits, friction, detents, latch and motor that add_joint refuses.
void check_joint_numbers(const Joint& joint);
// Adds a joint between two bodies, or between the world and a body. A joint's bodies never change.
// Throws PreconditionError, and adds nothing, for: a duplicate name; a missing body; a lower limit
// above the upper one; negative friction, detent, latch or motor
// numbers; a motor of another kind than hinge and slider; a number outside world_limits.
Entity add_joint(World& world, const JointDescription& description);
// Returns a copy of `joint` whose two frames coincide at `frame_ws` when the bodies are at their
// current poses.
Joint joint_at(const World& world, Joint joint, const Pose& frame_ws);

struct PlayerDescription {
    std::string_view name;  // unique in the world
    PlayerBody body;
    Pose origin_ws;
    Vec3 velocity_mps = Vec3::Zero();
    // Shape of the head's collider: a sphere; k_no_shape: the head touches nothing.
    ShapeId head_shape;
    BodyMeasures measures = {};  // measures before `scale`
    bool is_measured = false;    // false: the size is estimated while playing, from `measures` on
    double scale = 1.0;          // PlayerOrigin::scale
};
struct PlayerEntities {
    Entity player;
    Entity hands[k_hand_count];  // indexed by HandSide
};
// Adds a player and their two hands. Throws like add_body, and for body measures outside their
// range.
PlayerEntities add_player(World& world, const PlayerDescription& description);
// Also throws if head_shape is not a sphere in the library.
PlayerEntities add_player(World& world, const PlayerDescription& description,
                          const ShapeLibrary& shapes);

// Removes the entity from every column, together with a player's hands and a body's joints. Returns
// false for a stale handle. The cost does not depend on the number of other entities.
bool destroy(World& world, Entity entity);

// Rebuilds the caches if the columns were filled without the functions above, for example from a
// snapshot.
void sync_index(World& world);

// Returns k_no_entity if no entity has the id. Constant cost.
Entity find_by_id(const World& world, PersistentId id);
Entity find_by_name(const World& world, std::string_view name);
// The name that the entity was added with; empty for a stale handle, and for an entity that came
// with a snapshot and was never added here. Valid until an entity is added or destroyed.
std::string_view name_of(const World& world, Entity entity);

}  // namespace handhold
