#include "tools/lab/residual_probe.hpp"

#include <algorithm>
#include <limits>

#include "tools/lab/gauss_seidel.hpp"

namespace handhold::lab {
namespace {

constexpr int k_max_iterations = 50;

PositionSolver g_solver = &solve_positions;
bool g_is_armed = false;
std::vector<double> g_residuals;

double residual_m(const IslandView& island) {
    double worst = 0.0;
    for (const std::uint32_t i : island.island_blocks) {
        if (takes_part(island, island.blocks[i])) {
            worst = std::max(worst, block_error_m(island.bodies, island.blocks[i]));
        }
    }
    return worst;
}

void probe(const IslandView& island, const NewtonSettings& settings, SolveScratch& scratch) {
    const std::vector<SolverBody> start(island.bodies.begin(), island.bodies.end());
    g_residuals = {residual_m(island)};
    for (int iterations = 1; iterations <= k_max_iterations; ++iterations) {
        NewtonSettings few = settings;
        few.max_iterations = iterations;
        few.load_stepping_from_m = std::numeric_limits<double>::infinity();
        set_sweeps(iterations);
        const NewtonResult result = g_solver(island, few, scratch);
        if (result.iterations == iterations) {
            g_residuals.push_back(residual_m(island));
        }
        std::copy(start.begin(), start.end(), island.bodies.begin());
        if (result.iterations < iterations) {
            break;  // converged before this iteration
        }
    }
    set_sweeps(k_sweeps);
}

NewtonResult solve_and_probe(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    if (g_is_armed) {
        g_is_armed = false;
        probe(island, settings, scratch);
    }
    return g_solver(island, settings, scratch);
}

}  // namespace

PositionSolver probe_residuals(PositionSolver solver) {
    g_solver = solver;
    g_residuals.clear();
    return &solve_and_probe;
}

void arm_probe() { g_is_armed = true; }

const std::vector<double>& probed_residuals() { return g_residuals; }

}  // namespace handhold::lab
