#include "systems/physics/solve_phases.hpp"

#include <algorithm>

#include "engine/core/parallel.hpp"
#include "engine/core/profile.hpp"
#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// Smallest violation that starts another phase, at least twice the solver's tolerance: below lie
// rounding and the residual of a solved phase.
constexpr double k_violated_m = 2e-7;
constexpr double k_touching_m = 1e-5;  // closer contacts may support a body
// Overlap within a heap from which the hands that press it give way.
constexpr double k_heap_violated_m = 1e-3;
// Limit on the constraint blocks of a heap, summed over the contact searches of a frame. Above it,
// the heap's bodies keep their present contacts until the next frame. Other islands are not
// affected.
constexpr std::uint64_t k_max_heap_visits = 12'000;
constexpr int k_max_heap_rounds = 2;  // of a phase; what appears later waits for the next frame

enum class Phase : std::uint8_t { reach, forward, relax, backward, contradiction };

struct Solve {
    const SolvePhasesIo& io;
    const Tuning& tuning;
    StageStats& stats;

    double violated_m() const { return std::max(k_violated_m, 2.0 * tuning.solver.tolerance_m); }
    ConstraintGraph& graph() const { return io.frame.graph; }
    FrameGraph::PhaseBody& phase_of(std::uint32_t body) const { return io.frame.phase[body]; }
};

// --- Islands -------------------------------------------------------------------------------------

bool has_role(const Solve& s, const Island& island, BodyRole role) {
    return std::ranges::any_of(s.graph().bodies_of(island),
                               [&](std::uint32_t i) { return s.graph().bodies[i].role == role; });
}

std::optional<IslandErrors>& cached_errors(const Solve& s, const Island& island) {
    return s.io.frame.island_errors[static_cast<std::size_t>(&island - s.graph().islands.data())];
}
// Cached per island until its next solve.
const IslandErrors& errors_of(const Solve& s, const Island& island) {
    std::optional<IslandErrors>& errors = cached_errors(s, island);
    if (!errors) {
        errors = island_errors(s.graph(), island);
    }
    return *errors;
}
void clear_errors(const Solve& s, const Island& island) { cached_errors(s, island).reset(); }
// For all islands, after they were rebuilt.
void clear_errors(const Solve& s) { s.io.frame.island_errors.assign(s.graph().islands.size(), {}); }

bool has_hand_or_joint(const Solve& s, const Island& island) {
    return std::ranges::any_of(s.graph().blocks_of(island),
                               [&](std::uint32_t i) { return !is_contact(s.graph().blocks[i]); });
}

// True if the backward phase may push a player of this island: it has two players, or an active row
// with a body that the forward phase cannot move.
bool may_push(const Solve& s, const Island& island) {
    const auto players = std::ranges::count_if(s.graph().bodies_of(island), [&](std::uint32_t i) {
        return s.graph().bodies[i].role == BodyRole::translating;
    });
    if (players == 0) {
        return false;
    }
    const auto is_unmoved = [&](std::uint32_t i) {
        return s.graph().bodies[i].role == BodyRole::fixed ||
               s.graph().bodies[i].role == BodyRole::heavy;
    };
    return players > 1 || std::ranges::any_of(s.graph().blocks_of(island), [&](std::uint32_t i) {
               const RowBlock& block = s.graph().blocks[i];
               const bool active = !is_contact(block) ||
                                   contact_separation_m(s.graph().bodies, block) < k_touching_m;
               return active && (is_unmoved(block.a) || is_unmoved(block.b));
           });
}

// From now on players of this island take part in its push with their own mass, velocities
// included.
void mark_pushed(const Solve& s, const Island& island) {
    for (const std::uint32_t i : s.graph().bodies_of(island)) {
        s.phase_of(i).pushed = true;
    }
}

// --- Masses of a phase ---------------------------------------------------------------------------

// Factor on a body's inverse mass in a phase, in [0, 1].
double share_of(const Solve& s, const Island& island, std::uint32_t index, Phase phase) {
    const SolverBody& body = s.graph().bodies[index];
    const FrameGraph::PhaseBody& info = s.phase_of(index);
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
    const bool touches = std::ranges::any_of(s.graph().blocks_of(island), [&](std::uint32_t i) {
        const RowBlock& block = s.graph().blocks[i];
        return is_contact(block) && (block.a == index || block.b == index);
    });
    return touches && info.pushed ? 1.0 : 0.0;
}

void set_masses(const Solve& s, const Island& island, Phase phase) {
    for (const std::uint32_t i : s.graph().bodies_of(island)) {
        SolverBody& body = s.graph().bodies[i];
        const double share = share_of(s, island, i, phase);
        body.inverse_mass = share / body.mass_kg;
        body.inverse_inertia_bs.setZero();
        if (body.role != BodyRole::translating && share > 0.0) {
            body.inverse_inertia_bs = share * body.inertia_kgm2.cwiseInverse();
        }
    }
}

// --- Solving many islands ------------------------------------------------------------------------

NewtonSettings settings_of(const Solve& s, Phase phase) {
    const SolverTuning& tuning = s.tuning.solver;
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
std::uint64_t work_left(const Solve& s, const Island& island) {
    std::uint64_t spent = 0;
    for (const std::uint32_t i : s.graph().bodies_of(island)) {
        spent = std::max(spent, s.phase_of(i).work);
    }
    const WorkBudget budget;
    const std::uint64_t total =
        budget.positions +
        budget.per_block * std::min(s.graph().blocks_of(island).size(), budget.max_blocks);
    return total - std::min(spent, total);
}

// Solves the islands for which `wanted` is true, largest first, on all threads. Islands share no
// body, so the result does not depend on the distribution. Returns how many were solved.
template <typename Wanted>
std::size_t solve_islands(const Solve& s, Phase phase, Wanted&& wanted) {
    FrameGraph& frame = s.io.frame;
    ConstraintGraph& graph = s.graph();
    frame.island_order.clear();
    for (std::uint32_t i = 0; i < graph.islands.size(); ++i) {
        if (wanted(graph.islands[i])) {
            frame.island_order.push_back(i);
        }
    }
    sort_largest_first(graph, frame.island_order);
    if (frame.island_scratch.size() < graph.islands.size()) {
        frame.island_scratch.resize(graph.islands.size());
    }
    frame.island_results.assign(frame.island_order.size(), {});
    const NewtonSettings settings = settings_of(s, phase);
    auto solve_one = [&](std::size_t i) {
        HH_DETAIL_ZONE("island");
        const Island& island = graph.islands[frame.island_order[i]];
        NewtonSettings of_island = settings;
        of_island.max_work = work_left(s, island);
        set_masses(s, island, phase);
        const IslandView view{filter_of(phase),
                              graph.bodies,
                              graph.blocks,
                              graph.bodies_of(island),
                              graph.blocks_of(island),
                              graph.revision,
                              island.is_heap && phase != Phase::backward};
        const std::uint32_t index = frame.island_order[i];
        frame.island_results[i] =
            frame.position_solver(view, of_island, frame.island_scratch[index]);
        for (const std::uint32_t body : graph.bodies_of(island)) {
            s.phase_of(body).work += frame.island_results[i].work;
        }
        frame.island_errors[index] = errors_after(view, frame.island_results[i]);
    };
    parallel_for(frame.island_order.size(), solve_one);
    for (const NewtonResult& result : frame.island_results) {
        s.stats.newton_iterations += static_cast<std::uint64_t>(result.iterations);
        if (result.active_set_unconverged) {
            s.stats.count(Fallback::active_set_not_converged);
        }
        if (result.out_of_work) {
            s.stats.count(Fallback::solver_budget);
        }
        if (result.load_stepping != LoadStepping::none) {
            s.stats.count(result.load_stepping == LoadStepping::converged
                              ? Fallback::hands_load_stepped
                              : Fallback::load_stepping_failed);
        }
    }
    return frame.island_order.size();
}

// Adds the cost of the last contact search to each heap's count. Heaps above k_max_heap_visits are
// not searched again in this frame.
void count_heap_visits(const Solve& s) {
    for (const Island& island : s.graph().islands) {
        if (!island.is_heap) {
            continue;
        }
        std::uint64_t visits =
            0;  // islands change between searches: the largest count is inherited
        for (const std::uint32_t i : s.graph().bodies_of(island)) {
            visits = std::max(visits, s.phase_of(i).visits);
        }
        const bool was_searched = visits <= k_max_heap_visits;
        visits += s.graph().blocks_of(island).size();
        for (const std::uint32_t i : s.graph().bodies_of(island)) {
            s.phase_of(i).visits = visits;
            s.graph().bodies[i].is_searched = visits <= k_max_heap_visits;
        }
        if (was_searched && visits > k_max_heap_visits) {
            s.stats.count(Fallback::solver_budget);
        }
    }
}

bool is_searched(const Solve& s, const Island& island) {
    return std::ranges::all_of(s.graph().bodies_of(island),
                               [&s](std::uint32_t i) { return s.graph().bodies[i].is_searched; });
}

// Sweeps colliders to the solved poses. True if contacts found there overlap.
bool refresh_contacts(const Solve& s, OldPoints old_points) {
    FrameGraph& frame = s.io.frame;
    const FoundContacts found =
        refresh_contacts({s.io.collision, frame.proxies, frame.contacts, frame.graph,
                          frame.fresh_contacts, frame.proxy_updates, frame.displaced},
                         {s.tuning.contact.margin_m, s.tuning.contact.sweep_m}, old_points);
    if (found != FoundContacts::unchanged) {
        activate_islands(frame);
        ++s.stats.contact_rounds;
        count_heap_visits(s);
        clear_errors(s);
    }
    return found == FoundContacts::overlapping;
}

// Repeats a phase until no new contact overlaps; counts if the rounds are exhausted.
template <typename Wanted>
void solve_rounds(const Solve& s, Phase phase, Wanted&& wanted) {
    for (int round = 0; round < s.tuning.contact.max_rounds; ++round) {
        const auto wanted_now = [&](const Island& island) {
            const bool may_repeat = round == 0 || !island.is_heap ||
                                    (round < k_max_heap_rounds && is_searched(s, island));
            return may_repeat && wanted(island);
        };
        if (solve_islands(s, phase, wanted_now) == 0 ||
            !refresh_contacts(s, round == 0 ? OldPoints::replaced : OldPoints::kept)) {
            return;
        }
    }
    s.stats.count(Fallback::contact_rounds_exhausted);
}

// --- Phases --------------------------------------------------------------------------------------

void reach(const Solve& s) {
    HH_DETAIL_ZONE("reach");
    solve_islands(s, Phase::reach,
                  [&](const Island& island) { return has_hand_or_joint(s, island); });
    // build_constraints wrote reached_ws of all other bodies.
    for (const std::uint32_t i : s.graph().island_bodies) {
        s.phase_of(i).reached_ws = s.graph().bodies[i].pose_ws;
    }
    refresh_contacts(s, OldPoints::replaced);
}

bool is_pushed(const Solve& s, const Island& island) {
    return std::ranges::any_of(s.graph().bodies_of(island),
                               [&](std::uint32_t i) { return s.phase_of(i).pushed; });
}

// True if a heap overlaps deeply and may only come apart by pushing the player. A heap that touches
// nothing immovable can always give way, if not in this frame then in the next.
bool presses_player(const Solve& s, const Island& island) {
    return errors_of(s, island).heap_m > k_heap_violated_m &&
           (is_pushed(s, island) || may_push(s, island));
}

// True if forward has left such a heap: relax is next.
bool is_stuck(const Solve& s, const Island& island) {
    return presses_player(s, island) &&
           std::ranges::any_of(s.graph().bodies_of(island),
                               [&](std::uint32_t i) { return s.phase_of(i).work > 0; });
}

void forward(const Solve& s) {
    HH_DETAIL_ZONE("forward");
    solve_rounds(s, Phase::forward, [&](const Island& island) {
        const IslandErrors& errors = errors_of(s, island);
        if (is_stuck(s, island)) {
            return false;
        }
        return has_role(s, island, BodyRole::free) &&
               (errors.without_drives_m() > s.tuning.solver.tolerance_m ||
                errors.heap_m > k_heap_slack_m);
    });
}

// Heaps that forward could not solve with the hands where they are: lets the held bodies give way,
// so that backward finds the heap free of overlap.
void relax(const Solve& s) {
    HH_DETAIL_ZONE("relax");
    const auto wanted = [&](const Island& island) { return presses_player(s, island); };
    // Marked before the heap gives way, because it may separate from the wall that it touches now.
    for (const Island& island : s.graph().islands) {
        if (wanted(island)) {
            mark_pushed(s, island);
        }
    }
    solve_rounds(s, Phase::relax, wanted);
}

bool wants_backward(const Solve& s, const Island& island) {
    return errors_of(s, island).worst_m() > s.violated_m() &&
           (is_pushed(s, island) || may_push(s, island));
}

// Marks the islands to push, and restores players and held objects to their reach poses. False if
// there are none.
bool prepare_backward(const Solve& s) {
    bool any = false;
    for (const Island& island : s.graph().islands) {
        if (!wants_backward(s, island)) {
            continue;
        }
        any = true;
        ++s.stats.islands_pushed;
        mark_pushed(s, island);
        for (const std::uint32_t i : s.graph().bodies_of(island)) {
            SolverBody& body = s.graph().bodies[i];
            // Backward has its own budget. A heap that used up forward's budget must not make the
            // player's pose less exact.
            s.phase_of(i).work = 0;
            if (body.role == BodyRole::translating || s.phase_of(i).held) {
                body.pose_ws = s.phase_of(i).reached_ws;
            }
        }
        clear_errors(s, island);
    }
    return any;
}

void backward(const Solve& s) {
    HH_DETAIL_ZONE("backward");
    if (!prepare_backward(s)) {
        return;
    }
    const auto wanted = [&](const Island& island) {
        return is_pushed(s, island) && errors_of(s, island).worst_m() > s.violated_m();
    };
    solve_rounds(s, Phase::backward, wanted);
    // The contacts that forward found may all be satisfied at the reach poses, so that nothing was
    // solved and swept. Sweep once more for other obstacles.
    if (refresh_contacts(s, OldPoints::kept)) {
        solve_rounds(s, Phase::backward, wanted);
    }
}

void contradiction(const Solve& s) {
    HH_DETAIL_ZONE("contradiction");
    const auto wanted = [&](const Island& island) {
        const IslandErrors& errors = errors_of(s, island);
        return errors.without_drives_m() > s.violated_m() || presses_player(s, island);
    };
    for (const Island& island : s.graph().islands) {
        if (!wanted(island)) {
            continue;
        }
        s.stats.count(Fallback::contacts_contradict);
        if (may_push(s, island)) {
            mark_pushed(s, island);
        }
    }
    solve_rounds(s, Phase::contradiction, wanted);
}

}  // namespace

void solve_phases(const SolvePhasesIo& io, const Tuning& tuning, StageStats& stats) {
    const Solve s{io, tuning, stats};
    clear_errors(s);
    count_heap_visits(s);
    activate_islands(io.frame);
    reach(s);
    forward(s);
    relax(s);
    backward(s);
    contradiction(s);
    stats.islands += s.graph().islands.size();
}

}  // namespace handhold
