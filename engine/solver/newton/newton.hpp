// Solver, newton: the position solve. Damped Newton on all constraints of one island.

#pragma once

#include <cstdint>
#include <optional>

#include "engine/solver/newton/island_system.hpp"
#include "engine/solver/newton/settings.hpp"

namespace handhold {

enum class LoadStepping : std::uint8_t { none, converged, failed };

struct NewtonResult {
    int iterations = 0;                  // sum over all load steps
    double initial_drive_error_m = 0.0;  // largest drive error before the first iteration
    double residual_m = 0.0;             // largest error at the end (Row::residual)
    bool converged = false;              // residual_m < tolerance_m
    std::optional<JointError> joints;    // largest joint errors at the end; packed islands only
    // In some step the active set did not converge: inactive rows may overlap.
    bool active_set_unconverged = false;
    std::uint64_t work = 0;    // spent, in the unit of WorkBudget; packed islands spend none
    bool out_of_work = false;  // ended because it had spent IslandView::max_work
    // Load stepping, if the iterations ran out; failed: the bodies are where the full load left
    // them.
    LoadStepping load_stepping = LoadStepping::none;
};

// Moves the island's bodies, weighted by their inverse masses, until every row is satisfied or no
// step helps. An infeasible island ends at a regularised least-squares solution in which contacts
// outweigh drives by about 1e5, and joints outweigh contacts by 1e3.
NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch);

}  // namespace handhold
