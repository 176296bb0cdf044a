// Solver, newton: the load-stepping loop.
#include "engine/solver/newton/load_stepping.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr int k_load_steps = 4;
constexpr double k_load_step_tolerance_m = 1e-5;  // tolerance of all steps but the last

// Stops at the first load step that does not converge.
NewtonResult run_load_steps(const IslandView& island, const NewtonSettings& settings,
                            SolveScratch& scratch, SolveLoadStep solve) {
    NewtonSettings load_step_settings = settings;
    load_step_settings.tolerance_m = std::max(settings.tolerance_m, k_load_step_tolerance_m);
    scratch.load_stepped.restore_start(island);
    NewtonResult result;
    int iterations = 0;
    for (int load_step = 1; load_step <= k_load_steps; ++load_step) {
        scratch.load_stepped.withhold_load(island,
                                           1.0 - static_cast<double>(load_step) / k_load_steps);
        result = solve(island, load_step < k_load_steps ? load_step_settings : settings, scratch);
        iterations += result.iterations;
        if (!result.converged) {
            break;
        }
    }
    scratch.load_stepped.withhold_load(island, 0.0);
    result.iterations = iterations;
    return result;
}

}  // namespace

void reserve_load_stepping(const IslandView& island, SolveScratch& scratch) {
    scratch.load_stepped.reserve(island);
    reserve_poses(island, scratch.full_load);
}

bool needs_load_stepping(const NewtonResult& full_load, const NewtonSettings& settings) {
    return !full_load.converged && full_load.iterations == settings.max_iterations &&
           full_load.initial_drive_error_m - full_load.residual_m > settings.load_stepping_from_m;
}

NewtonResult solve_by_load_stepping(const IslandView& island, const NewtonSettings& settings,
                                    const NewtonResult& full_load, SolveScratch& scratch,
                                    SolveLoadStep solve) {
    save_poses(island, scratch.full_load);
    NewtonResult load_stepped = run_load_steps(island, settings, scratch, solve);
    load_stepped.iterations += full_load.iterations;
    if (load_stepped.converged) {
        load_stepped.initial_drive_error_m = full_load.initial_drive_error_m;
        load_stepped.load_stepping = LoadStepping::converged;
        return load_stepped;
    }
    restore_poses(island, scratch.full_load);
    // Loads the triads with the restored targets, because the velocity solve continues from them.
    // If the load failed, the velocity solve would load by itself.
    scratch.triads.load(island);
    NewtonResult result = full_load;
    result.iterations = load_stepped.iterations;
    result.load_stepping = LoadStepping::failed;
    return result;
}

}  // namespace handhold
