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

// Moves one island's bodies until its constraint rows are met; contract as solve_positions.
using PositionSolver = NewtonResult (*)(const IslandView&, const NewtonSettings&, SolveScratch&);

// Groups of free bodies connected by joints, by row of the RigidBody column. Empty if there are no
// joints.
struct JointGroups {
    std::vector<std::uint32_t> of_body;  // representative body of the group, equal for its members
    // By representative: joints connect the group to something that a hand cannot move.
    std::vector<std::uint8_t> anchored;

    bool is_anchored(std::size_t body_row) const {
        return !of_body.empty() && anchored[of_body[body_row]] != 0;
    }
    bool share_group(std::size_t row, std::size_t other_row) const {
        return row == other_row || (!of_body.empty() && of_body[row] == of_body[other_row]);
    }
};

// Data passed between the physics stages within one frame. Not state: rebuilt every frame, kept
// only so that warm frames allocate nothing.
struct FrameGraph {
    // One element per body or player, sorted by persistent id; `proxies`, `entities`, `phase` and
    // graph.bodies share the index. A body without a collider has shape k_no_shape and touches
    // nothing.
    std::vector<ColliderProxy> proxies;  // written by place_colliders; solve_phases moves them
    std::vector<Entity> entities;
    struct Identified {
        PersistentId id;
        Entity entity;
    };
    std::vector<Identified> by_id;  // scratch of place_colliders
    struct PhaseBody {
        Pose reached_ws;  // pose after the reach phase
        // Players: 1/kappa, the share of the inverse mass used in the forward phase; in [0, 1].
        double forward_share = 0.0;
        bool held = false;  // held by a hand, or connected by joints to a held body
        // Players: a hand grips something fixed, driven or heavy, or two players grip each other.
        bool grips_surface = false;
        bool pushed = false;  // the backward or contradiction phase ran on its island
        Vec3 velocity_before_mps = Vec3::Zero();  // players: before the velocity solve
        std::uint64_t work = 0;    // spent by the position solves of its islands (WorkBudget)
        double push_back_m = 0.0;  // players: displacement of the origin by contacts this frame
    };
    // graph.bodies may have one more element at the end: the world, if a joint connects to it.
    std::vector<PhaseBody> phase;
    JointGroups joint_groups;  // written by group_joints

    std::vector<ContactPoint> contacts;  // written by find_contacts, solve_phases
    std::vector<IgnoredPair> ignored;    // written by find_contacts
    ConstraintGraph graph;  // written by build_constraints, solve_phases, update_velocities

    // Called by solve_phases for every island and phase. The measuring tools replace it to compare
    // methods.
    PositionSolver position_solver = &solve_positions;

    // Scratch.
    std::vector<ContactPoint> fresh_contacts;
    std::vector<std::uint32_t> body_of_row;   // by row of RigidBody: index into graph.bodies
    std::vector<RowBlock> hand_blocks;        // written by build_constraints, by row of Grab
    std::vector<std::uint32_t> island_order;  // largest first
    std::vector<NewtonResult> island_results;
    // A penetrating body that finish_positions may restore to its last valid pose; its state after
    // the phases.
    struct PenetratingBody {
        std::uint32_t body = 0;
        // Index into the islands of the phases; islands are rebuilt afterwards. Past the end: no
        // constraint row involved the body.
        std::uint32_t island = 0;
        double error_m = 0.0;  // largest error of its constraint rows, except hand rows
        Pose pose_ws;
        Vec3 velocity_mps = Vec3::Zero();
        Vec3 spin_radps = Vec3::Zero();
    };
    std::vector<PenetratingBody> penetrating_bodies;  // by island
    MissedOverlaps hidden_overlaps;  // written by finish_positions; read by update_velocities
    // Largest errors, by island. After a solve that met all its blocks: an upper bound. Otherwise
    // none until computed on demand.
    std::vector<std::optional<IslandErrors>> island_errors;
    std::vector<VelocityResult> velocity_results;  // by island
    std::vector<SolveScratch> island_scratch;
    std::vector<double> overlap_m;             // by body
    std::vector<std::uint32_t> overlaps_with;  // by body: the other body; itself if none
};

}  // namespace handhold
