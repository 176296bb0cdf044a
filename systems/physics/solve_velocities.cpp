#include "systems/physics/solve_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/parallel.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "systems/physics/shared/mass_shares.hpp"

namespace handhold {
namespace {

VelocitySettings settings_of(const Tuning& tuning) {
    VelocitySettings settings;
    settings.restitution_speed_mps = tuning.contact.restitution_speed_mps;
    settings.regularisation.contact = tuning.solver.positions.regularisation.contact;
    settings.regularisation.joint = tuning.solver.positions.regularisation.joint;
    settings.friction_passes = tuning.solver.friction_passes;
    return settings;
}

void solve_islands(FrameGraph& frame, const Tuning& tuning, StageStats& stats) {
    ConstraintGraph& graph = frame.graph;
    const VelocitySettings settings = settings_of(tuning);
    if (frame.island_scratch.size() < graph.islands.size()) {
        frame.island_scratch.resize(graph.islands.size());
    }
    frame.velocity_results.assign(graph.islands.size(), {});
    frame.island_order.resize(graph.islands.size());
    std::iota(frame.island_order.begin(), frame.island_order.end(), 0U);
    sort_largest_first(graph, frame.island_order);
    auto solve_one = [&](std::size_t order) {
        const std::uint32_t i = frame.island_order[order];
        const Island& island = graph.islands[i];
        set_velocity_masses(island, tuning.phases, frame);
        const WorkBudget budget;
        const IslandView view{
            BlockFilter::all,
            graph.bodies,
            graph.blocks,
            graph.bodies_of(island),
            graph.blocks_of(island),
            graph.revision,
            island.is_heap,
            budget.velocities +
                budget.per_block * std::min(graph.blocks_of(island).size(), budget.max_blocks)};
        frame.velocity_results[i] =
            solve_island_velocities(view, settings, frame.island_scratch[i]);
    };
    parallel_for(graph.islands.size(), solve_one);
    for (const VelocityResult& result : frame.velocity_results) {
        if (result.unconverged) {
            stats.count(Fallback::friction_not_converged);
        }
        if (result.out_of_work) {
            stats.count(Fallback::solver_budget);
        }
    }
}

// Limits the spin of free bodies: impulses on a thin body can spin it without bound.
Vec3 clamp_spin(const SolverBody& body, double limit_radps, StageStats& stats) {
    const double square = body.spin_radps.squaredNorm();
    if (body.role != BodyRole::free || square <= limit_radps * limit_radps) {
        return body.spin_radps;
    }
    stats.count(Fallback::object_speed_clamped);
    return body.spin_radps * (limit_radps / std::sqrt(square));
}

void write_velocities(const SolveVelocitiesIo& io, const LocomotionTuning& tuning,
                      StageStats& stats) {
    for (const std::uint32_t i : io.frame.active.list) {
        const SolverBody& body = io.frame.graph.bodies[i];
        const Entity entity = io.frame.entities[i];
        if (body.role == BodyRole::translating) {
            io.player_velocity.at(entity).linear_mps = body.velocity_mps;
        } else if (body.role != BodyRole::fixed) {
            io.body_velocity.at(entity) = {body.velocity_mps,
                                           clamp_spin(body, tuning.object_spin_max_radps, stats)};
        }
    }
}

}  // namespace

void solve_velocities(const SolveVelocitiesIo& io, const Tuning& tuning, StageStats& stats) {
    for (const std::uint32_t i : io.frame.active.list) {
        io.frame.phase[i].velocity_before_mps = io.frame.graph.bodies[i].velocity_mps;
    }
    solve_islands(io.frame, tuning, stats);
    write_velocities(io, tuning.locomotion, stats);
}

}  // namespace handhold
