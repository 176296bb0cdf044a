// Solver, newton: assembly for both the position and the velocity solve, for islands that are
// solved row by row.
#include "engine/solver/newton/island_system.hpp"

#include <algorithm>
#include <cmath>

#include "engine/solver/model/geometric_stiffness.hpp"

namespace handhold {

bool has_contact(std::span<const Row> rows) {
    return std::ranges::any_of(rows, [](const Row& row) { return row.group == RowGroup::contact; });
}

double longest_move(const SolveScratch& scratch) {
    double longest = 0.0;
    for (const Vec3& move : scratch.moves_m) {
        longest = std::max(longest, move.norm());
    }
    return longest;
}

void clear_stiffness(const IslandView& island, SolveScratch& scratch) {
    scratch.stiffness.assign(island.island_bodies.size(), Mat3::Zero());
}

void prepare_inertia(const IslandView& island, SolveScratch& scratch) {
    scratch.inverse_inertia_ws.resize(island.island_bodies.size());
    for (const std::uint32_t index : island.island_bodies) {
        const SolverBody& body = island.bodies[index];
        Mat3& inverse = scratch.inverse_inertia_ws[body.slot];
        if (body.inverse_inertia_bs.squaredNorm() == 0.0) {
            inverse.setZero();
            continue;
        }
        inverse = stiffened(inverse_inertia_ws(body), scratch.stiffness[body.slot]);
    }
}

void gather_residuals(SolveScratch& scratch) {
    scratch.values.resize(scratch.rows.size());
    std::ranges::transform(scratch.rows, scratch.values.begin(), &Row::residual);
}

double gather_moves(std::span<const RowMatrix::Twist> moves, SolveScratch& scratch) {
    scratch.moves_m.resize(moves.size());
    scratch.rotations_rad.resize(moves.size());
    double largest = 0.0;
    for (std::size_t slot = 0; slot < moves.size(); ++slot) {
        const RowMatrix::Twist& move = moves[slot];
        scratch.moves_m[slot] = Vec3(move[0], move[1], move[2]);
        scratch.rotations_rad[slot] = Vec3(move[3], move[4], move[5]);
        largest = std::max(largest, scratch.rotations_rad[slot].squaredNorm());
    }
    return std::sqrt(largest);
}

}  // namespace handhold
