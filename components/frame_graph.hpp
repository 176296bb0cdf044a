#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "components/active_bodies.hpp"
#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/player.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"
#include "engine/ecs/column_watch.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/solver/contact/missed_overlaps.hpp"
#include "engine/solver/model/islands.hpp"
#include "engine/solver/newton/newton.hpp"
#include "engine/solver/newton/velocities.hpp"

namespace handhold {

// Groups of free bodies that joints connect. Both arrays are indexed by element of the RigidBody
// column, and are empty if there are no joints.
struct JointGroups {
    // Index of the group's representative, the same for all its members.
    std::vector<std::uint32_t> of_body;
    // Valid at representatives: 1 if joints connect the group to something that a hand cannot move.
    std::vector<std::uint8_t> anchored;

    bool is_anchored(std::size_t body_index) const {
        return !of_body.empty() && anchored[of_body[body_index]] != 0;
    }
    bool share_group(std::size_t index, std::size_t other_index) const {
        return index == other_index || (!of_body.empty() && of_body[index] == of_body[other_index]);
    }
};

// Data passed between the physics stages within one frame. Not state: without the data of earlier
// frames, the next frame has the same result. The data of bodies at rest is reused from frame to
// frame (ActiveBodies).
struct FrameGraph {
    // One element per body or player, sorted by persistent id. `proxies`, `entities`, `phase` and
    // graph.bodies share this index. The proxy of a body without a collider has shape k_no_shape
    // and touches nothing.
    std::vector<ColliderProxy> proxies;  // written by place_colliders, moved by solve_phases
    std::vector<Entity> entities;
    struct Identified {
        PersistentId id;
        Entity entity;
    };
    std::vector<Identified> by_id;  // scratch of place_colliders
    ActiveBodies active;
    // Copies of the columns from the last run of place_colliders, which processes only what
    // changed.
    struct Watches {
        ColumnWatch<PersistentId> persistent_id;
        ColumnWatch<Collider> collider;
        ColumnWatch<CollisionFilter> filter;
        ColumnWatch<RigidBody> body;
        ColumnWatch<BodyPose> body_pose;
        ColumnWatch<BodyStart> body_start;
        ColumnWatch<BodyVelocity> body_velocity;
        ColumnWatch<LastValidPose> last_valid;
        ColumnWatch<PlayerOrigin> origin;
    };
    Watches watches;
    std::vector<std::uint32_t> index_of_slot;  // index into `entities`, indexed by Entity::slot
    std::vector<ColliderProxy> proxy_updates;  // scratch: proxies to send to the collision world
    double heavy_body_kg = 0.0;                // PhaseTuning's value in the last build_constraints
    std::uint64_t proxy_set = 0;               // CollisionWorld::proxy_set() after place_colliders
    struct PhaseBody {
        Pose reached_ws;  // pose after the reach phase
        // From the next three fields, systems/physics/shared/mass_shares.hpp decides which bodies
        // each phase may move.
        //
        // Players: momentum_share of the heaviest body that a hand holds rigidly (Grab::kind is
        // held, not Grab::jointed), from 0 (light bodies do not move the player) to 1.
        double forward_share = 0.0;
        bool held = false;  // held by a hand, or connected by joints to a held body
        // Players: a hand grips a fixed, kinematic or heavy body or another player, or another
        // player grips this one.
        bool grips_surface = false;
        // The body's island may push players in this frame. Set by the relax, backward and
        // contradiction phases (mark_pushed), and by accept_solution for players whose hands grip.
        bool pushed = false;
        // Velocity before the velocity solve: of the centre of mass, and angular, m/s and rad/s.
        Vec3 velocity_before_mps = Vec3::Zero();
        Vec3 spin_before_radps = Vec3::Zero();
        // Work that the position solves of the body's islands have spent (WorkBudget). The backward
        // phase starts again from 0.
        std::uint64_t work = 0;
        // Number of contacts that this frame's contact searches have visited in the body's heaps.
        std::uint64_t visits = 0;
    };
    // If a joint connects a body to the world, `phase` and graph.bodies have one element more than
    // `entities`: the last one stands for the world.
    std::vector<PhaseBody> phase;
    JointGroups joint_groups;                        // written by group_joints
    Column<GrippableBody> grippable_bodies;          // written by pose_grippable_bodies; by player
    std::vector<GrippablePlayer> grippable_players;  // scratch of pose_grippable_bodies
    std::vector<PushBack> push_backs;                // one per player; written by finish_positions

    std::vector<ContactPoint> contacts;  // written by find_contacts, solve_phases
    std::vector<IgnoredPair> ignored;    // written by find_contacts
    ConstraintGraph graph;  // written by build_constraints, solve_phases, solve_velocities

    // Scratch.
    std::vector<ContactPoint> fresh_contacts;
    std::vector<ContactPoint> impacts;  // written by solve_phases
    // By element of the RigidBody column: index into graph.bodies.
    std::vector<std::uint32_t> body_of_element;
    // Written by build_constraints, in the order of the Grab column.
    std::vector<RowBlock> hand_blocks;
    std::vector<std::uint32_t> island_order;  // islands to solve, largest first
    std::vector<NewtonResult> island_results;
    // A penetrating body or player that finish_positions may restore to its last valid pose, with
    // its state after the phases.
    struct PenetratingBody {
        std::uint32_t body = 0;
        // Index into the islands as solve_phases built them (the islands are rebuilt afterwards).
        std::uint32_t island = 0;
        // Largest error of the body's constraint rows, except those of hands, and of its hidden
        // overlaps.
        double error_m = 0.0;
        // The body whose motion in this frame also moved valid_ws: the fixed or kinematic body that
        // this body penetrates, or the listed body whose overlap added this body to the list.
        // `body` itself if there is none.
        std::uint32_t carrier = 0;
        Pose valid_ws;  // last valid pose of the body, moved with the carrier
        Pose pose_ws;   // pose and velocities as the phases left them
        Vec3 velocity_mps = Vec3::Zero();
        Vec3 spin_radps = Vec3::Zero();
        bool is_restored = false;  // true: the restore to valid_ws is kept
    };
    // Sorted by island. Within an island, bodies whose restore was kept at the first evaluation
    // come first.
    std::vector<PenetratingBody> penetrating_bodies;
    MissedOverlaps hidden_overlaps;  // written by finish_positions; read by record_valid_poses
    // Cache of the largest errors, one element per island. Exact, or an upper bound if the island's
    // last solve converged. nullopt: not computed since the island last changed.
    std::vector<std::optional<IslandErrors>> island_errors;
    std::vector<VelocityResult> velocity_results;  // indexed by island
    std::vector<SolveScratch> island_scratch;
    std::vector<double> overlap_m;  // overlap depth, indexed by body
    // Overlapped body, indexed by body; the body itself if there is none.
    std::vector<std::uint32_t> overlaps_with;
};

// Makes the bodies of all islands active, because the solver may move them.
inline void activate_islands(FrameGraph& frame) {
    for (const std::uint32_t body : frame.graph.island_bodies) {
        frame.active.add(body);
    }
}

}  // namespace handhold
