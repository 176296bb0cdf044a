#include "systems/physics/shared/phase_solve.hpp"

#include <algorithm>
#include <optional>

#include "engine/core/parallel.hpp"
#include "engine/core/profile.hpp"

namespace handhold {
namespace {

NewtonSettings settings_of(const SolverTuning& tuning, Phase phase) {
    NewtonSettings settings = tuning.positions;
    if (phase == Phase::forward) {
        settings.regularisation.drive = tuning.forward_drive_regularisation;
    }
    return settings;
}

BlockFilter filter_of(Phase phase) {
    switch (phase) {
        case Phase::reach:
            return BlockFilter::without_contacts;
        case Phase::relax:
        case Phase::contradiction:
            return BlockFilter::without_drives;
        default:
            return BlockFilter::all;
    }
}

// The errors that are known from a solve: if it converged and included every block, no error
// exceeds its residual.
std::optional<IslandErrors> errors_after(const IslandView& island, const NewtonResult& result) {
    const auto counts = [&island](std::uint32_t i) { return takes_part(island, island.blocks[i]); };
    if (!result.converged || !std::ranges::all_of(island.island_blocks, counts)) {
        return std::nullopt;
    }
    return IslandErrors{result.residual_m, result.residual_m, result.residual_m, 0.0,
                        result.joints};
}

// The work that the island may still spend in this frame. Islands merge and split between phases:
// the body that has spent most determines it.
std::uint64_t work_left(const FrameGraph& frame, const Island& island) {
    std::uint64_t spent = 0;
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        spent = std::max(spent, frame.phase[i].work);
    }
    const WorkBudget budget;
    const std::uint64_t total =
        budget.positions +
        budget.per_block * std::min(frame.graph.blocks_of(island).size(), budget.max_blocks);
    return total - std::min(spent, total);
}

}  // namespace

void solve_chosen_islands(Phase phase, const SolverTuning& tuning, PositionSolver solver,
                          FrameGraph& frame, StageStats& stats) {
    ConstraintGraph& graph = frame.graph;
    sort_largest_first(graph, frame.island_order);
    if (frame.island_scratch.size() < graph.islands.size()) {
        frame.island_scratch.resize(graph.islands.size());
    }
    frame.island_results.assign(frame.island_order.size(), {});
    const NewtonSettings settings = settings_of(tuning, phase);
    auto solve_one = [&](std::size_t i) {
        HH_DETAIL_ZONE("island");
        const Island& island = graph.islands[frame.island_order[i]];
        set_masses(island, phase, frame);
        const IslandView view{filter_of(phase),
                              graph.bodies,
                              graph.blocks,
                              graph.bodies_of(island),
                              graph.blocks_of(island),
                              graph.revision,
                              island.is_heap && phase != Phase::backward,
                              work_left(frame, island)};
        const std::uint32_t index = frame.island_order[i];
        frame.island_results[i] = solver(view, settings, frame.island_scratch[index]);
        for (const std::uint32_t body : graph.bodies_of(island)) {
            frame.phase[body].work += frame.island_results[i].work;
        }
        frame.island_errors[index] = errors_after(view, frame.island_results[i]);
    };
    parallel_for(frame.island_order.size(), solve_one);
    for (const NewtonResult& result : frame.island_results) {
        stats.newton_iterations += static_cast<std::uint64_t>(result.iterations);
        if (result.active_set_unconverged) {
            stats.count(Fallback::active_set_not_converged);
        }
        if (result.out_of_work) {
            stats.count(Fallback::solver_budget);
        }
        if (result.load_stepping != LoadStepping::none) {
            stats.count(result.load_stepping == LoadStepping::converged
                            ? Fallback::hands_load_stepped
                            : Fallback::load_stepping_failed);
        }
    }
}

}  // namespace handhold
