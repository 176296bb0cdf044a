#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/islands.hpp"
#include "engine/solver/model/rows.hpp"
#include "engine/solver/newton/newton.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "tests/engine/collision/scene.hpp"

// Shared by the solver's tests: bodies with consistent masses and inertias, blocks, and a graph
// that is solved island by island.
namespace handhold::test {

inline SolverBody fixed_body(std::uint64_t id, const Pose& pose_ws = {}) {
    SolverBody body;
    body.id = id;
    body.pose_ws = pose_ws;
    return body;
}

inline SolverBody free_body(std::uint64_t id, double mass_kg, const Vec3& inertia_kgm2,
                            const Pose& pose_ws = {}) {
    SolverBody body = fixed_body(id, pose_ws);
    body.role = BodyRole::free;
    body.mass_kg = mass_kg;
    body.inertia_kgm2 = inertia_kgm2;
    body.inverse_mass = 1.0 / mass_kg;
    body.inverse_inertia_bs = inertia_kgm2.cwiseInverse();
    return body;
}

inline SolverBody ball(std::uint64_t id, double mass_kg, double radius_m,
                       const Pose& pose_ws = {}) {
    return free_body(id, mass_kg, Vec3::Constant(0.4 * mass_kg * radius_m * radius_m), pose_ws);
}

inline SolverBody translating_body(std::uint64_t id, double mass_kg, const Pose& pose_ws = {}) {
    SolverBody body = fixed_body(id, pose_ws);
    body.role = BodyRole::translating;
    body.mass_kg = mass_kg;
    body.inverse_mass = 1.0 / mass_kg;
    return body;
}

inline Pose random_pose(Random& random, double size_m = 2.0) {
    return {random.vector(size_m), random.rotation()};
}

// A box of 0.5 to 20 kg, a few decimetres large: its moments of inertia are those of a solid.
inline SolverBody random_free_body(std::uint64_t id, Random& random) {
    const double mass_kg = random.between(0.5, 20.0);
    const Vec3 half_m{random.between(0.05, 0.3), random.between(0.05, 0.3),
                      random.between(0.05, 0.3)};
    const Vec3 squares = half_m.cwiseProduct(half_m);
    const Vec3 inertia = (mass_kg / 3.0) * (Vec3::Constant(squares.sum()) - squares);
    return free_body(id, mass_kg, inertia, random_pose(random));
}

inline RowBlock row_block(RowKind kind, std::uint32_t a, std::uint32_t b,
                          const Vec3& point_a_bs = Vec3::Zero(),
                          const Vec3& point_b_bs = Vec3::Zero()) {
    RowBlock block;
    block.kind = kind;
    block.a = a;
    block.b = b;
    block.point_a_bs = point_a_bs;
    block.point_b_bs = point_b_bs;
    return block;
}

inline RowBlock random_block(RowKind kind, std::uint32_t a, std::uint32_t b, Random& random) {
    const Vec3 anchor_a_bs = random.vector(0.5);
    RowBlock block = row_block(kind, a, b, anchor_a_bs, random.vector(0.5));
    block.rotation_a_bs = random.rotation();
    block.rotation_b_bs = random.rotation();
    block.normal_b_bs = random.direction();
    return block;
}

// Moves b's frame of the block onto a's, which leaves no error.
inline void meet(std::span<const SolverBody> bodies, RowBlock& block) {
    const Pose& a = bodies[block.a].pose_ws;
    const Pose& b = bodies[block.b].pose_ws;
    block.point_b_bs = inverse_transform_point(b, transform_point(a, block.point_a_bs));
    block.rotation_b_bs = b.rotation.conjugate() * (a.rotation * block.rotation_a_bs);
}

// Tighter than the runtime's defaults, so that closed forms can be compared to 1e-7.
inline NewtonSettings tight_settings() {
    NewtonSettings settings;
    settings.tolerance_m = 1e-8;
    settings.regularisation.drive = 1e-6;
    return settings;
}

struct SolverScene {
    ConstraintGraph graph;
    SolveScratch scratch;

    SolverBody& body(std::size_t index) { return graph.bodies[index]; }
    RowBlock& block(std::size_t index) { return graph.blocks[index]; }

    double error_m(std::size_t block) const {
        return block_error_m(graph.bodies, graph.blocks[block]);
    }

    IslandView view(const Island& island, BlockFilter filter = BlockFilter::all) {
        return {filter,
                graph.bodies,
                graph.blocks,
                graph.bodies_of(island),
                graph.blocks_of(island),
                graph.revision,
                island.is_heap};
    }
    // Solves every island. The result is that of the last, in most tests the only one.
    NewtonResult solve_positions(const NewtonSettings& settings = tight_settings(),
                                 BlockFilter filter = BlockFilter::all) {
        build_islands(graph);
        NewtonResult result;
        for (const Island& island : graph.islands) {
            result = handhold::solve_positions(view(island, filter), settings, scratch);
        }
        return result;
    }
    void solve_velocities(const VelocitySettings& settings = {}) {
        build_islands(graph);
        for (const Island& island : graph.islands) {
            solve_island_velocities(view(island), settings, scratch);
        }
    }
    std::vector<Row> rows() const {
        std::vector<Row> all;
        for (std::uint32_t i = 0; i < graph.blocks.size(); ++i) {
            append_rows(graph.bodies, graph.blocks[i], i, all);
        }
        return all;
    }
};

}  // namespace handhold::test
