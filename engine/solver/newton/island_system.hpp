#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"
#include "engine/solver/model/rows.hpp"
#include "engine/solver/newton/active_set.hpp"
#include "engine/solver/newton/load_stepped_drives.hpp"
#include "engine/solver/newton/regularisation.hpp"
#include "engine/solver/packed/triad_system.hpp"

// One island as linear equations: what the solve of positions and that of velocities share.
namespace handhold {

// Kept between solves so that a warm one allocates nothing. One for each island that is solved at
// the same time.
struct SolveScratch {
    std::vector<Row> rows;
    std::vector<Row> previous_rows;        // of the step before; lambda belongs to them
    std::vector<Mat3> inverse_inertia_ws;  // by slot
    std::vector<Mat3> stiffness;           // by slot
    std::vector<Vec3> moves_m;             // by slot
    std::vector<Vec3> rotations_rad;
    std::vector<double> values;
    std::vector<double> lambda;
    std::vector<double> approach_mps;  // by row: normal velocity before the solve
    struct Friction {
        std::size_t row = 0;     // first of its rows in `rows`
        std::size_t width = 1;   // how many: their multipliers' length is bounded
        double limit = 0.0;      // N s or N m s, where `normal` is none
        std::size_t normal = 0;  // row whose multiplier times `coefficient` is the limit
        double coefficient = 0.0;
        bool slides = false;
        bool is_frictionless = false;  // slips freely: its contacts are wedged
    };
    std::vector<Friction> frictions;
    bool has_energy_source = false;  // a hand or a detent may give energy
    RowSystem system;
    TriadSystem triads;  // in place of all the others where it serves
    LoadSteppedDrives load_stepped;
    std::vector<Pose> full_load;  // by slot, where steps ran out before hands were led
};

bool has_contact(std::span<const Row> rows);

// No geometric stiffness, for all of the island's bodies.
void clear_stiffness(const IslandView& island, SolveScratch& scratch);
// Inverse inertia of all bodies at their present poses, with the stiffness.
void prepare_inertia(const IslandView& island, SolveScratch& scratch);

// Times that a solve whose answer is too large to be meant softens its rows.
inline constexpr int k_max_regularisation_retries = 3;
// The farthest that rows of contacts may move a body, in what they lack: a lever of 1 m.
inline constexpr double k_max_move_ratio = 10.0;

// Hands by the harmonic mean of the diagonal, so that what one holds weighs as much as the other's;
// all else by its own entry. Times `factor`.
void regularise(std::span<const Row> rows, const Regularisation& regularisation, double factor,
                RowSystem& system);

// W J^T lambda of the system's last solve by slot; returns the largest turn in radians.
double gather_moves(SolveScratch& scratch);
// Of the moves gathered, metres.
double longest_move(const SolveScratch& scratch);

}  // namespace handhold
