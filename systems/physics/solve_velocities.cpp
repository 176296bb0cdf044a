#include "systems/physics/solve_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/core/parallel.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "systems/physics/shared/mass_shares.hpp"
#include "systems/physics/shared/speed_limits.hpp"

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

// --- Hands that overpower a mechanism ------------------------------------------------------------

// Square of the speed of the body's points, root mean square, relative to a velocity.
double square_speed(const SolverBody& body, const Vec3& velocity_mps, const Vec3& spin_radps) {
    const Vec3 spin_bs = body.pose_ws.rotation.conjugate() * spin_radps;
    return velocity_mps.squaredNorm() + spin_bs.cwiseAbs2().dot(body.inertia_kgm2) / body.mass_kg;
}

// Work of the muscles that move the island's hands in their play spaces, J: the impulses of the
// drives along the motions that they demand.
double work_of_hands_j(const ConstraintGraph& graph, const Island& island) {
    double work_j = 0.0;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        const RowBlock& block = graph.blocks[i];
        if (is_drive(block)) {
            work_j -= block.impulse_ws_ns.dot(block.drive_velocity_ws_mps) +
                      block.angular_impulse_ws_nms.dot(block.drive_spin_ws_radps);
        }
    }
    return work_j;
}

// True if the work of hands made a jointed body of the island too fast.
bool are_hands_too_strong(const SolveVelocitiesIo& io, const Island& island,
                          const LocomotionTuning& tuning) {
    const FrameGraph& frame = io.frame;
    const std::optional<ObjectSpeedLimit> limits =
        object_speed_limit(frame, island, io.reference, io.origin, tuning);
    if (!limits) {
        return false;
    }
    const Vec3 reference = limits->reference_mps;
    double least = limits->max_mps * limits->max_mps;  // square of the speed that is too fast
    bool knows_driven = false;
    const auto is_too_fast = [&](std::uint32_t index) {
        const SolverBody& body = frame.graph.bodies[index];
        if (body.role != BodyRole::free) {
            return false;
        }
        const double square = square_speed(body, body.velocity_mps - reference, body.spin_radps);
        if (square <= least) {
            return false;
        }
        if (!knows_driven) {
            const double driven_mps = driven_speed(frame, island, reference);
            least = std::max(least, driven_mps * driven_mps);
            knows_driven = true;
        }
        const FrameGraph::PhaseBody& before = frame.phase[index];
        return square > std::max(least, square_speed(body, before.velocity_before_mps - reference,
                                                     before.spin_before_radps));
    };
    const auto has_fast_body = [&](std::uint32_t i) {
        const RowBlock& block = frame.graph.blocks[i];
        return is_joint(block) && (is_too_fast(block.a) || is_too_fast(block.b));
    };
    return std::ranges::any_of(frame.graph.blocks_of(island), has_fast_body) &&
           work_of_hands_j(frame.graph, island) > 0.0;
}

void restore_velocities(const Island& island, FrameGraph& frame) {
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        frame.graph.bodies[i].velocity_mps = frame.phase[i].velocity_before_mps;
        frame.graph.bodies[i].spin_radps = frame.phase[i].spin_before_radps;
    }
}

// --- Islands -------------------------------------------------------------------------------------

IslandView view_of(ConstraintGraph& graph, const Island& island) {
    const WorkBudget budget;
    return {BlockFilter::all,
            graph.bodies,
            graph.blocks,
            graph.bodies_of(island),
            graph.blocks_of(island),
            graph.revision,
            island.is_heap,
            budget.velocities +
                budget.per_block * std::min(graph.blocks_of(island).size(), budget.max_blocks)};
}

void solve_islands(const SolveVelocitiesIo& io, const Tuning& tuning, StageStats& stats) {
    FrameGraph& frame = io.frame;
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
        IslandView view = view_of(graph, island);
        VelocityResult& result = frame.velocity_results[i];
        result = solve_island_velocities(view, settings, frame.island_scratch[i]);
        if (are_hands_too_strong(io, island, tuning.locomotion)) {
            restore_velocities(island, frame);
            view.filter = BlockFilter::without_drives;
            result = solve_island_velocities(view, settings, frame.island_scratch[i]);
            result.without_drives = true;
        }
    };
    parallel_for(graph.islands.size(), solve_one);
    for (const VelocityResult& result : frame.velocity_results) {
        if (result.unconverged) {
            stats.count(Fallback::friction_not_converged);
        }
        if (result.out_of_work) {
            stats.count(Fallback::solver_budget);
        }
        if (result.without_drives) {
            stats.count(Fallback::object_speed_clamped);
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
        io.frame.phase[i].spin_before_radps = io.frame.graph.bodies[i].spin_radps;
    }
    solve_islands(io, tuning, stats);
    write_velocities(io, tuning.locomotion, stats);
}

}  // namespace handhold
