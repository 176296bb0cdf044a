#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/islands.hpp"
#include "engine/solver/model/rows.hpp"
#include "engine/solver/newton/newton.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "tests/engine/collision/scene.hpp"

// What the solver's tests share: bodies with the masses that they really have, rows, and a graph
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

inline SolverBody player_body(std::uint64_t id, double mass_kg, const Pose& pose_ws = {}) {
    SolverBody body = fixed_body(id, pose_ws);
    body.role = BodyRole::translating;
    body.mass_kg = mass_kg;
    body.inverse_mass = 1.0 / mass_kg;
    return body;
}

inline Pose random_pose(Random& random, double size_m = 2.0) {
    return {random.vector(size_m), random.rotation()};
}

// A body of 0.5 to 20 kg, a few decimetres large, whose moments of inertia a solid could have.
inline SolverBody random_free_body(std::uint64_t id, Random& random) {
    const double mass_kg = random.between(0.5, 20.0);
    const Vec3 half_m(random.between(0.05, 0.3), random.between(0.05, 0.3),
                      random.between(0.05, 0.3));
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
    RowBlock block = row_block(kind, a, b, random.vector(0.5), random.vector(0.5));
    block.rotation_a_bs = random.rotation();
    block.rotation_b_bs = random.rotation();
    block.normal_b_bs = random.direction();
    return block;
}

// Moves b's end of the block to where a's is: no error is left.
inline void meet(std::span<const SolverBody> bodies, RowBlock& block) {
    const Pose& a = bodies[block.a].pose_ws;
    const Pose& b = bodies[block.b].pose_ws;
    block.point_b_bs = inverse_transform_point(b, transform_point(a, block.point_a_bs));
    block.rotation_b_bs = b.rotation.conjugate() * (a.rotation * block.rotation_a_bs);
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
                graph.revision};
    }
    // Every island's; the result is that of the last, which in most tests is the only one.
    NewtonResult solve_positions(const NewtonSettings& settings = {},
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
            handhold::solve_velocities(view(island), settings, scratch);
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
