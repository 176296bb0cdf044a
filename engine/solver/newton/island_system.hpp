// Solver, newton: one island as linear equations. Used by the position solve (newton.cpp) and the
// velocity solve (velocities.cpp).

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"
#include "engine/solver/model/regularisation.hpp"
#include "engine/solver/model/rows.hpp"
#include "engine/solver/newton/active_set.hpp"
#include "engine/solver/newton/load_stepped_drives.hpp"
#include "engine/solver/packed/triad_system.hpp"
#include "engine/solver/sweeps/row_sweeps.hpp"

namespace handhold {

// Buffers kept between solves, so that a warm solve does not allocate. One per island that is
// solved concurrently.
struct SolveScratch {
    std::vector<Row> rows;
    std::vector<Row> previous_rows;        // rows of the previous step; lambda belongs to these
    std::vector<Mat3> inverse_inertia_ws;  // indexed by slot
    std::vector<Mat3> stiffness;           // indexed by slot
    std::vector<Vec3> moves_m;             // indexed by slot
    std::vector<Vec3> rotations_rad;
    std::vector<double> values;
    std::vector<double> lambda;
    // Indexed by row, m/s: bias added to the row's velocity. Restitution: coefficient times the
    // row's velocity before the solve (negative: approaching); motor: minus the target speed.
    std::vector<double> approach_mps;
    struct Friction {
        std::size_t row = 0;     // index of its first row in `rows`
        std::size_t width = 1;   // number of rows; the length of their multipliers is bounded
        double limit = 0.0;      // N s or N m s; used if `coefficient` is 0
        std::size_t normal = 0;  // row whose multiplier times `coefficient` is the limit
        double coefficient = 0.0;
        bool slides = false;
    };
    std::vector<Friction> frictions;
    RowSystem system;
    RowSweeps sweeps;  // used instead of `system` if the island is a heap
    std::vector<BoundedRows> bounded;
    // The solution with restitution, kept while the one without restitution is computed.
    std::vector<double> bouncing_lambda;
    std::vector<Vec3> bouncing_moves_m;
    std::vector<Vec3> bouncing_rotations_rad;
    // Used instead of the members above if TriadSystem::load accepts the island.
    TriadSystem triads;
    LoadSteppedDrives load_stepped;
    // Indexed by slot: result of the solve with full load, before load stepping.
    std::vector<Pose> full_load;
};

bool has_contact(std::span<const Row> rows);

// Sets the geometric stiffness of all bodies of the island to 0.
void clear_stiffness(const IslandView& island, SolveScratch& scratch);
// Computes all bodies' inverse inertia at their current poses, including the geometric stiffness.
void prepare_inertia(const IslandView& island, SolveScratch& scratch);

// A solve whose step is implausibly long is repeated with more regularisation, at most this often.
inline constexpr int k_max_regularisation_retries = 3;
inline constexpr double k_retry_regularisation_increase = 100.0;
// Longest plausible move of a body by contact rows, relative to the residual. A body that rotates
// about a point ten k_angle_lever_m away moves this far.
inline constexpr double k_max_move_ratio = 10.0;

// Harmonic mean of the diagonal of J W J^T as assembled (model/regularisation.hpp).
template <typename System>
double mean_diagonal(std::span<const Row> rows, const System& system) {
    HarmonicMean mean;
    for (std::size_t i = 0; i < system.size();) {
        const std::size_t width = rows[i].width;
        double sum = 0.0;
        for (std::size_t end = i + width; i < end; ++i) {
            sum += system.diagonal(i);
        }
        mean.add(static_cast<double>(width), sum);
    }
    return mean.value();
}

// Writes the system's alpha by the formula of model/regularisation.hpp. `drive_scale`: s_i of drive
// rows.
template <typename System>
void regularise(std::span<const Row> rows, const Regularisation& regularisation, double factor,
                double drive_scale, System& system) {
    for (std::size_t i = 0; i < system.size(); ++i) {
        const double scale = rows[i].group == RowGroup::drive ? drive_scale : system.diagonal(i);
        system.alpha()[i] = factor * relative_regularisation(rows[i], regularisation) * scale;
    }
}

// Copies the residuals of `rows` to `values`.
void gather_residuals(SolveScratch& scratch);
// Copies the moves W J^T lambda of a solve to `scratch`. `moves` is indexed by slot. Returns the
// largest rotation in radians.
double gather_moves(std::span<const RowMatrix::Twist> moves, SolveScratch& scratch);
// Longest translation of the gathered moves, metres.
double longest_move(const SolveScratch& scratch);

}  // namespace handhold
