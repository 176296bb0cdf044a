#include "systems/physics/shared/phase_solve.hpp"

#include <algorithm>
#include <optional>

#include "engine/core/parallel.hpp"
#include "engine/core/profile.hpp"

namespace handhold {
namespace {

// Factor on a body's inverse mass in a phase, in [0, 1].
double share_of(const FrameGraph& frame, const Island& island, std::uint32_t index, Phase phase) {
    const SolverBody& body = frame.graph.bodies[index];
    const FrameGraph::PhaseBody& info = frame.phase[index];
    const bool is_held_still = phase == Phase::backward && body.in_heap;
    switch (body.role) {
        case BodyRole::fixed:
            return 0.0;
        case BodyRole::free:
            return is_held_still ? 0.0 : 1.0;
        case BodyRole::heavy:
            return phase == Phase::forward || phase == Phase::relax || is_held_still ? 0.0 : 1.0;
        case BodyRole::translating:
            break;
    }
    switch (phase) {
        case Phase::reach:
            return info.grips_surface ? 1.0 : info.forward_share;
        case Phase::forward:
            return info.grips_surface ? 0.0 : info.forward_share;
        case Phase::relax:
            return 0.0;
        case Phase::backward:
            return 1.0;
        case Phase::contradiction:
            break;
    }
    // Without grips only their own collider moves a player, and only if the island may push them.
    const bool touches = std::ranges::any_of(frame.graph.blocks_of(island), [&](std::uint32_t i) {
        const RowBlock& block = frame.graph.blocks[i];
        return is_contact(block) && (block.a == index || block.b == index);
    });
    return touches && info.pushed ? 1.0 : 0.0;
}

void set_masses(const Island& island, Phase phase, FrameGraph& frame) {
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        SolverBody& body = frame.graph.bodies[i];
        const double share = share_of(frame, island, i, phase);
        body.inverse_mass = share / body.mass_kg;
        body.inverse_inertia_bs.setZero();
        if (body.role != BodyRole::translating && share > 0.0) {
            body.inverse_inertia_bs = share * body.inertia_kgm2.cwiseInverse();
        }
    }
}

NewtonSettings settings_of(const SolverTuning& tuning, Phase phase) {
    const double hand =
        phase == Phase::forward ? tuning.forward_drive_regularisation : tuning.drive_regularisation;
    return {.max_iterations = tuning.max_iterations,
            .tolerance_m = tuning.tolerance_m,
            .step_tolerance_m = tuning.step_tolerance_m,
            .regularisation = {hand, tuning.contact_regularisation, tuning.joint_regularisation},
            .geometric_stiffness_from_m = tuning.geometric_stiffness_from_m,
            .load_stepping_from_m = tuning.load_stepping_from_m,
            // max_* is never below min_*, or below the contacts' initial regularisation.
            .schedule = {std::max(tuning.max_drive_regularisation, tuning.min_drive_regularisation),
                         tuning.min_drive_regularisation,
                         std::max(tuning.max_contact_regularisation, tuning.contact_regularisation),
                         tuning.regularisation_decrease, tuning.regularisation_increase,
                         tuning.linear_decrease_steps, tuning.linear_decrease_ratio,
                         tuning.max_step_rotation_rad, tuning.min_step_scale}};
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

// The errors known from a solve: if it converged with every block, none exceeds its residual.
std::optional<IslandErrors> errors_after(const IslandView& island, const NewtonResult& result) {
    const auto counts = [&island](std::uint32_t i) { return takes_part(island, island.blocks[i]); };
    if (!result.converged || !std::ranges::all_of(island.island_blocks, counts)) {
        return std::nullopt;
    }
    return IslandErrors{result.residual_m, result.residual_m, result.residual_m, 0.0,
                        result.joints};
}

// What the island may still spend in this frame. Islands change between the phases: the body that
// has spent most counts.
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
        NewtonSettings of_island = settings;
        of_island.max_work = work_left(frame, island);
        set_masses(island, phase, frame);
        const IslandView view{filter_of(phase),
                              graph.bodies,
                              graph.blocks,
                              graph.bodies_of(island),
                              graph.blocks_of(island),
                              graph.revision,
                              island.is_heap && phase != Phase::backward};
        const std::uint32_t index = frame.island_order[i];
        frame.island_results[i] = solver(view, of_island, frame.island_scratch[index]);
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
