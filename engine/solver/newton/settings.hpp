// Solver, newton: settings of the position and velocity solves, with the runtime's defaults.
// SolverTuning (components/tuning.hpp) holds NewtonSettings as it is.

#pragma once

#include <cstdint>

#include "engine/solver/model/regularisation.hpp"

namespace handhold {

// How the regularisation of drives and contacts changes from step to step, and how long a Newton
// step may be. See regularisation_schedule.hpp.
struct StepControl {
    double max_drive_regularisation = 1e-2;  // >= min_drive_regularisation
    double min_drive_regularisation = 1e-9;
    // For contacts that contradict each other; at least their initial regularisation.
    double max_contact_regularisation = 1e-3;
    // Factor on the drives' regularisation after a step that reduced the error, and after one that
    // did not.
    double regularisation_decrease = 0.03;
    double regularisation_increase = 10.0;
    // This many consecutive unscaled steps that each leave less than `linear_decrease_ratio` of the
    // error count as one that reduced it.
    int linear_decrease_steps = 3;
    double linear_decrease_ratio = 0.95;
    double max_step_rotation_rad = 1.0;  // largest rotation of a body per step; longer steps are
                                         // scaled down
    double min_step_scale = 0.3;  // a step scaled below this is repeated with more regularisation
};

// Work that the solves of one island may spend in a frame. Counted, never timed, so that the same
// frame ends at the same point everywhere. The unit is one visit of a row by a sweep, or
// k_multiply_adds of a factorisation: it costs about 30 ns.
struct WorkBudget {
    static constexpr std::uint64_t k_multiply_adds = 64;
    std::uint64_t positions = 250'000;  // budget of all phases together
    std::uint64_t velocities = 100'000;
    std::uint64_t per_block = 60;  // added to both for each of the island's first max_blocks
    std::size_t max_blocks = 4000;
};

struct NewtonSettings {
    int max_iterations = 30;         // load stepping may take five times as many
    double tolerance_m = 1e-7;       // converged if every error is below
    double step_tolerance_m = 1e-9;  // a smaller step ends the solve
    // Initial regularisation; that of contacts and joints never falls below.
    Regularisation regularisation{};
    double geometric_stiffness_from_m = 1e-4;  // residual above which geometric stiffness is added
    // Drives that the iterations moved closer by this much, but not to the target, are load-stepped
    // (load_stepping.hpp).
    double load_stepping_from_m = 0.05;
    StepControl schedule{};
};

struct VelocitySettings {
    double touch_m = 1e-4;               // contacts with a smaller separation take part
    double restitution_speed_mps = 0.2;  // slower impacts do not bounce
    // Drives are regularised more than in positions: there is no iteration that would reduce the
    // regularisation where drives contradict each other.
    Regularisation regularisation{.drive = 1e-6};
    int friction_passes = 6;       // limit of the stick-slip iteration
    double tolerance_mps = 1e-10;  // iterative refinement ends below this residual
    int refinements = 8;           // limit of the iterative refinement
};

}  // namespace handhold
