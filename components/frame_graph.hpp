#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/solver/contact/missed_overlaps.hpp"
#include "engine/solver/model/islands.hpp"
#include "engine/solver/newton/newton.hpp"
#include "engine/solver/newton/velocities.hpp"

namespace handhold {

// Moves one island's bodies until its rows are met: as solve_positions.
using PositionSolver = NewtonResult (*)(const IslandView&, const NewtonSettings&, SolveScratch&);

// Free bodies that joints tie together; empty where there is no joint. By the rows of the body
// column.
struct JointGroups {
    std::vector<std::uint32_t> of_body;  // a body of the group: the same for all of them
    std::vector<std::uint8_t> anchored;  // by that body: the group hangs on something unmoved

    bool is_anchored(std::size_t body_row) const {
        return !of_body.empty() && anchored[of_body[body_row]] != 0;
    }
    bool share_group(std::size_t row, std::size_t other_row) const {
        return row == other_row || (!of_body.empty() && of_body[row] == of_body[other_row]);
    }
};

// What the physics stages hand on to each other within one frame. Not state: filled anew in every
// frame, kept only so that warm frames allocate nothing.
struct FrameGraph {
    // One entry a body or player, sorted by persistent id: the same index in all of these and in
    // graph.bodies. What has no collider has no shape (k_no_shape) and touches nothing.
    std::vector<ColliderProxy> proxies;  // written by place_colliders; solve_phases moves them
    std::vector<Entity> entities;
    struct Identified {
        PersistentId id;
        Entity entity;
    };
    std::vector<Identified> by_id;  // scratch of place_colliders
    struct PhaseBody {
        Pose reached_ws;  // where the reach phase left it
        double forward_share =
            0.0;            // players: 1/kappa; how much of 1/mass the forward phase grants
        bool held = false;  // in a hand, or tied to what is
        // players: a hand holds on to something fixed, driven or heavy, or two players to each
        // other
        bool grips_surface = false;
        bool pushed = false;  // the backward or contradiction phase ran on its island
        Vec3 velocity_before_mps = Vec3::Zero();  // players: before the velocity solve
        double push_back_m = 0.0;  // players: how far contacts moved the origin in this frame
    };
    // As graph.bodies, whose last may be one more: the world, where a joint hangs on it.
    std::vector<PhaseBody> phase;
    JointGroups joint_groups;  // written by group_joints

    std::vector<ContactPoint> contacts;  // written by find_contacts, solve_phases
    std::vector<IgnoredPair> ignored;    // written by find_contacts
    ConstraintGraph graph;  // written by build_constraints, solve_phases, update_velocities

    // Asked by solve_phases for every island and phase. The measuring tools put the methods here
    // that this one is compared with.
    PositionSolver position_solver = &solve_positions;

    // Scratch.
    std::vector<ContactPoint> fresh_contacts;
    std::vector<std::uint32_t> body_of_row;   // by row of RigidBody: into graph.bodies
    std::vector<RowBlock> hand_blocks;        // written by build_constraints, by row of Grab
    std::vector<std::uint32_t> island_order;  // largest first
    std::vector<NewtonResult> island_results;
    // A body that finish_positions puts back, as the phases left it.
    struct PenetratingBody {
        std::uint32_t body = 0;
        // In which the phases left it: islands are found anew since. Beyond them: no row held it.
        std::uint32_t island = 0;
        double error_m = 0.0;  // the worst of its own rows, hands excepted
        Pose pose_ws;
        Vec3 velocity_mps = Vec3::Zero();
        Vec3 spin_radps = Vec3::Zero();
    };
    std::vector<PenetratingBody> penetrating_bodies;  // by island
    MissedOverlaps hidden_overlaps;  // written by finish_positions; read by update_velocities
    // By island. After a solve that met all its blocks: what none exceeds; after any other, until
    // asked for: none.
    std::vector<std::optional<IslandErrors>> island_errors;
    std::vector<VelocityResult> velocity_results;  // by island
    std::vector<SolveScratch> island_scratch;
    std::vector<double> overlap_m;  // by body
    std::vector<std::uint32_t> overlaps_with;
};

}  // namespace handhold
