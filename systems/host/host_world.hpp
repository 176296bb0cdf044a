#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <handhold/handhold.h>

#include "components/world.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "systems/frame/frame_of_host.hpp"
#include "systems/host/host_call.hpp"
#include "systems/host/host_growth.hpp"
#include "systems/host/host_surfaces.hpp"
#include "systems/rigs/body_rig.hpp"
#include "systems/snapshot/snapshot.hpp"

// The objects behind the C interface's opaque pointers.
namespace handhold {

// Data of the C interface about a shape, in addition to the library's entry.
struct HostShape {
    std::uint32_t generation = 0;  // generation of the id's current or last shape
    // The library's frame (centre of mass, principal axes) in the frame in which the host made the
    // shape.
    Pose frame;
    bool is_moved = false;  // false: `frame` is the identity
};

struct UserData {
    std::uint64_t value = 0;
};

struct BodyRigSlot {
    std::unique_ptr<BodyRig> rig;
    SkeletonPose pose;  // scratch
};

// One hand at the end of the last step. hh_hand_state has its impulse, and the next step's events
// are differences from it.
struct HandReport {
    GripKind grip = GripKind::none;
    Entity body = k_no_entity;
    bool is_player = false;  // true: `body` is a player
    double since_s = 0.0;
    Vec3 impulse_ns = Vec3::Zero();  // impulse on the gripped entity
    Entity touched = k_no_entity;    // entity that the open palm touches
};

// How a player's samples were corrected at the end of the last step.
struct SpaceReport {
    Pose correction;            // the samples' space in play space
    bool is_announced = false;  // hh_player_recenter announced it
};

struct JointReport {
    bool latched = false;
    bool at_limit = false;
};

// A contact of a player's head, or of what a hand holds.
struct HostContact {
    Entity player;
    std::int32_t side = -1;     // -1: the head
    Entity held = k_no_entity;  // null: the head
    Entity other;
    double impulse_ns = 0.0;
    Vec3 point_ws = Vec3::Zero();

    bool is_same(const HostContact& contact) const {
        return player == contact.player && side == contact.side && held == contact.held &&
               other == contact.other;
    }
};

}  // namespace handhold

// These two have the names of the C interface.
// NOLINTBEGIN(readability-identifier-naming)
struct hh_mesh {
    std::atomic<std::uint32_t> references{1};
    std::shared_ptr<const handhold::Mesh> mesh;
    std::shared_ptr<const handhold::TriangleTree> tree;
    std::shared_ptr<const handhold::GripMesh> grip;  // null: not for hands
};

struct hh_world {
    explicit hh_world(const hh_world_def& def);
    ~hh_world();
    hh_world(const hh_world&) = delete;
    hh_world& operator=(const hh_world&) = delete;

    hh_world_def settings;
    handhold::ShapeLibrary shapes;
    std::vector<handhold::HostShape> host_shapes;  // indexed by ShapeId::index
    std::vector<handhold::ShapeId> head_shapes;    // shapes of players' heads, which stay
    handhold::GripMeshLibrary grip_meshes;
    handhold::World world;
    handhold::Tuning tuning;
    handhold::FrameCaches caches;
    handhold::StageStats stats;

    // Not state: none of it changes what a step computes.
    handhold::Column<handhold::UserData> user_data;
    handhold::Column<handhold::BodyRigSlot> body_rigs;  // indexed by player
    handhold::Column<handhold::HandReport> hands;
    handhold::Column<handhold::JointReport> joints;
    handhold::Column<handhold::SpaceReport> spaces;    // indexed by player
    std::vector<handhold::HostContact> contacts;       // contacts of the last step
    std::vector<handhold::HostContact> last_contacts;  // contacts of the step before
    std::vector<hh_contact> contact_list;              // all contacts of the last step
    std::vector<hh_event> events;
    mutable std::vector<std::byte> packed_events;  // copies for hosts that know a shorter hh_event

    // Scratch of a step.
    std::vector<double> impulse_shares;  // reported share of each constraint block's impulse
    std::vector<handhold::PlayerInput> inputs;
    std::vector<std::uint8_t> repeats_samples;  // indexed by index of `inputs`
    std::vector<handhold::TrackingSample> samples;
    bool shows_hands = true;                  // the last step ran the shown stages
    std::uint64_t samples_too_far_ahead = 0;  // number in this step, until finish_step counts them
    std::uint64_t samples_too_old = 0;
    bool has_named_clock = false;  // the log has been told of samples on another clock
    bool has_named_pose = false;   // the log has been told of a tracked pose that is not valid
    std::vector<std::byte> snapshot;
    // Assets of the shapes as of `assets_revision`.
    std::optional<handhold::SnapshotAssets> assets;
    std::uint64_t assets_revision = 0;
    bool may_recycle_shapes = false;  // shapes were removed since the last step
    // True if colliders are at the present poses of bodies and heads: no call has changed the world
    // since the last query.
    bool has_placed_colliders = false;
    std::vector<std::uint64_t> near_ids;  // scratch of queries
    std::vector<hh_hit> hits;             // scratch of queries

    bool is_in_match = false;  // a match steps the world (host_match.hpp)

    // For hosts with their own physics.
    handhold::HostSurfaces surfaces;
    handhold::StageStats search_stats;  // counters of queries between steps: ignored
    bool is_stepping = false;           // true between hh_world_begin_step and hh_world_end_step
    double begun_dt_s = 0.0;
    std::vector<hh_hand_constraint> hand_constraints;
    std::vector<hh_player_motion> player_motions;
    std::vector<hh_velocity_change> velocity_changes;
    std::vector<handhold::Entity> held_bodies;  // free bodies that hands held in the last step
    std::vector<handhold::SolvedPlayer> solved_players;     // scratch
    std::vector<handhold::BodyVelocity> solved_velocities;  // scratch, in the order of the column
    std::vector<handhold::BodyVelocity>
        begun_velocities;  // velocities before hh_world_begin_step, indexed like the column
    std::vector<std::uint8_t> are_placed;  // 1: placed since then; indexed like the column
    std::vector<std::uint8_t> is_there;    // scratch of hh_world_place_bodies, indexed like it
};
// NOLINTEND(readability-identifier-naming)

namespace handhold {

// Returns the world, for calls that change it.
inline hh_world& world_of(hh_world* world) {
    require(world != nullptr, HH_ERROR_NULL, "the world is null");
    require(!world->surfaces.is_asking(), HH_ERROR_STATE,
            "the world is asking your surface query: calls inside of it may only read");
    world->has_placed_colliders = false;
    return *world;
}
inline const hh_world& world_of(const hh_world* world) {
    require(world != nullptr, HH_ERROR_NULL, "the world is null");
    return *world;
}
// Throws HH_ERROR_STATE if called between hh_world_begin_step and hh_world_end_step.
inline void require_idle(const hh_world& host) {
    require(!host.is_stepping, HH_ERROR_STATE, "a step has begun: hh_world_end_step comes first");
}
inline Entity body_of(const hh_world& host, hh_body body) {
    const Entity entity = entity_of(body);
    require(host.world.body.contains(entity), HH_ERROR_HANDLE, "no body with this id");
    return entity;
}
inline Entity player_of(const hh_world& host, hh_player player) {
    const Entity entity = entity_of(player);
    require(host.world.player.contains(entity), HH_ERROR_HANDLE, "no player with this id");
    return entity;
}
inline Entity joint_of(const hh_world& host, hh_joint joint) {
    const Entity entity = entity_of(joint);
    require(host.world.joint.contains(entity), HH_ERROR_HANDLE, "no joint with this id");
    return entity;
}
inline HandSide side_of(hh_side side) {
    require(side == HH_LEFT || side == HH_RIGHT, HH_ERROR_VALUE, "a side is HH_LEFT or HH_RIGHT");
    return side == HH_LEFT ? HandSide::left : HandSide::right;
}
// The shape behind an id; k_no_shape for the null id.
ShapeId shape_of(const hh_world& host, hh_shape shape);

// The shape of heads with this radius, at least k_smallest_head_m. It has no id in the C interface
// and is never removed, so that a snapshot saved before a player was added or removed can still be
// restored.
ShapeId head_shape(hh_world& host, double wanted_m);
// Radii that heads may have: those of a ShapeLibrary's spheres, and head.radius_m times any scale
// of a player.
inline constexpr double k_smallest_head_m = 1e-3;
inline constexpr double k_largest_head_m = 100.0;
// Number of shapes without those of heads.
std::size_t shape_count(const hh_world& host);

// Convert between a body's library frame and its host frame, in which the host made its shape.
const HostShape* moved_shape_of(const hh_world& host, Entity body);  // null: the frames are equal
Pose host_pose_of(const hh_world& host, Entity body);
Pose host_pose_of(const hh_world& host, Entity body, const Pose& library_pose_ws);
Pose library_pose(const hh_world& host, Entity body, const Pose& host_pose_ws);
// Converts a pose from the body's library frame to its host frame, and back.
Pose to_host_bs(const hh_world& host, Entity body, const Pose& pose_bs);
Pose from_host_bs(const hh_world& host, Entity body, const Pose& pose_bs);

// The pose in play space of the space in which a player's samples are given (HeadTracking's shift).
Pose samples_in_play_space(const hh_world& host, Entity player);
// The pose of a wrist in what the samples give: of the player, or of the tuning.
Pose hand_in_controller(const hh_world& host, Entity player, HandSide side);
// The pose of that space in the world, which hosts call the player's origin.
Pose samples_space_ws(const hh_world& host, Entity player);
// The pose of the play space for such an origin.
Pose play_space_ws(const hh_world& host, Entity player, const Pose& samples_space_ws);
// Updates `spaces`. makes_events: adds an event for each player whose samples' correction has
// changed since the last report.
void report_recentrings(hh_world& host, bool makes_events);

// The given name, or one made from the id of the next entity. That id is part of the state, so
// replays after a restore give equal names. HH_ERROR_NAME if it is taken; HH_ERROR_STATE inside a
// begun step.
std::string new_name(const hh_world& host, const char* name, const char* kind);

// Removes an entity, with the joints of a body and the hands of a player, from the world and from
// this layer's data. HH_ERROR_STATE inside a begun step.
void remove_entity(hh_world& host, Entity entity);
void set_user_data(hh_world& host, Entity entity, std::uint64_t value);
std::uint64_t user_data_of(const hh_world& host, Entity entity);

// Called before and after a step. Events are the differences between its end and the end of the
// step before.
void begin_events(hh_world& host);
void finish_events(hh_world& host);
// Called after a restore. Differences from the state before the restore make no events.
void forget_events(hh_world& host);

}  // namespace handhold
