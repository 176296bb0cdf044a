#pragma once

#include <cstdint>
#include <optional>

#include "engine/solver/newton/island_system.hpp"

// Damped Newton on the positions of one island.
namespace handhold {

struct NewtonSettings {
    int max_iterations = 30;  // five times as many at most where hands are led
    double tolerance_m = 1e-8;
    double step_tolerance_m = 1e-9;
    Regularisation regularisation{};           // at first; contacts and joints never have less
    double geometric_stiffness_from_m = 1e-4;  // residual above which geometric stiffness is added
    // Hands that the iterations took so much nearer, but not all the way, are led:
    // solve_by_load_stepping.hpp.
    double load_stepping_from_m = 0.05;
    StepControl schedule{};
};

enum class LoadStepping : std::uint8_t { none, converged, failed };

struct NewtonResult {
    int iterations = 0;                  // of all parts, where hands were led
    double initial_drive_error_m = 0.0;  // worst of the hands' errors before the first
    double residual_m = 0.0;             // worst point, angle (at its lever) or overlap at the end
    bool converged = false;              // residual below the tolerance
    std::optional<JointError> joints;    // worst of them at the end, where all rows always hold
    bool active_set_unconverged =
        false;  // a step left rows out that may overlap: its changes of the active set ran out
    LoadStepping load_stepping =
        LoadStepping::none;  // part by part, where the steps ran out; in vain: as they left it
};

// Moves the island's bodies, by their inverse masses, until every row is met or no step helps.
// Infeasible islands end at a least-squares compromise in which
// contacts outweigh hands by about 1e5, and joints contacts by 1e3.
NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch);

}  // namespace handhold
