#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/dense_system.hpp"
#include "engine/solver/rows.hpp"

// Damped Newton on the positions of one island, and the one velocity solve.
namespace handhold {

struct NewtonSettings {
    int max_iterations = 30;
    double tolerance_m = 1e-7;
    double step_tolerance_m = 1e-8;
    double hand_softness =
        1e-6;  // first regularisation of hand rows, relative to the harmonic mean of the diagonal
};

struct NewtonResult {
    int iterations = 0;
    double residual_m = 0.0;  // worst point, angle (at its lever) or overlap at the end
    bool converged = false;   // residual below the tolerance
};

// Kept between solves so that a warm one allocates nothing. One for each island that is solved at
// the same time.
struct SolveScratch {
    std::vector<Row> rows;
    std::vector<Mat3> inverse_inertia_ws;  // by slot
    std::vector<Mat3> stiffness;           // by slot
    std::vector<Vec3> moves_m;             // by slot
    std::vector<Vec3> turns_rad;
    std::vector<double> values;
    std::vector<double> lambda;
    std::vector<double> approach_mps;  // by row: normal velocity before the solve
    DenseSystem system;
};

enum class BlockFilter : std::uint8_t { all, hands, contacts };

// An island's part of the graph. Blocks between two bodies with zero inverse mass are passed over.
struct IslandView {
    BlockFilter filter = BlockFilter::all;
    std::span<SolverBody> bodies;  // of the whole graph
    std::span<RowBlock> blocks;
    std::span<const std::uint32_t> island_bodies;
    std::span<const std::uint32_t> island_blocks;
};

// Moves the island's bodies, by their inverse masses, until every row is met or no step helps.
// Writes each block's error_m. Infeasible islands end at a least-squares compromise in which
// contacts outweigh hands by about 1e5.
NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch);

struct VelocitySettings {
    double touch_m = 1e-4;               // contacts closer than this count
    double restitution_speed_mps = 0.2;  // slower impacts do not bounce
};
// One solve over the same rows: hands move as they are driven, contacts v_n >= -e v_n(before).
// Writes velocities and impulses.
void solve_velocities(const IslandView& island, const VelocitySettings& settings,
                      SolveScratch& scratch);

}  // namespace handhold
