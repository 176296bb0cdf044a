#include "systems/physics/solve_phases.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "engine/core/profile.hpp"
#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// Smallest violation that starts another phase. At least twice the solver's tolerance, because
// smaller ones are rounding errors or residuals of a solved phase.
constexpr double k_violated_m = 2e-7;
// Overlap within a heap from which the hands that press it give way.
constexpr double k_heap_violated_m = 1e-3;
// Limit on the constraint blocks of a heap, summed over the contact searches of a frame. Above it,
// the heap's bodies keep their present contacts until the next frame. Other islands are not
// affected.
constexpr std::uint64_t k_max_heap_visits = 12'000;
constexpr int k_max_heap_rounds =
    2;  // rounds of a phase; contacts that appear later wait for the next frame

struct Solve {
    PositionSolver solver;
    const SolvePhasesIo& io;
    const Tuning& tuning;
    StageStats& stats;

    double violated_m() const {
        return std::max(k_violated_m, 2.0 * tuning.solver.positions.tolerance_m);
    }
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
// Forgets the cached errors of all islands, after the islands were rebuilt.
void clear_errors(const Solve& s) { s.io.frame.island_errors.assign(s.graph().islands.size(), {}); }

// --- Rounds of solving and of searching contacts -------------------------------------------------

// Solves the islands for which `wanted` is true. Returns how many were solved.
template <typename Wanted>
std::size_t solve_islands(const Solve& s, Phase phase, Wanted&& wanted) {
    std::vector<std::uint32_t>& chosen = s.io.frame.island_order;
    chosen.clear();
    for (std::uint32_t i = 0; i < s.graph().islands.size(); ++i) {
        if (wanted(s.graph().islands[i])) {
            chosen.push_back(i);
        }
    }
    solve_chosen_islands(phase, s.tuning.solver, s.solver, s.io.frame, s.stats);
    return chosen.size();
}

// Adds the cost of the last contact search to each heap's count. Heaps above k_max_heap_visits are
// not searched again in this frame.
void count_heap_visits(const Solve& s) {
    for (const Island& island : s.graph().islands) {
        if (!island.is_heap) {
            continue;
        }
        // Islands merge and split between searches. An island takes the largest count of its
        // bodies.
        std::uint64_t visits = 0;
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

MovingContacts moving_contacts(const Solve& s) {
    FrameGraph& frame = s.io.frame;
    return {.collision = s.io.collision,
            .proxies = frame.proxies,
            .contacts = frame.contacts,
            .graph = frame.graph,
            .scratch = frame.fresh_contacts,
            .updates = frame.proxy_updates,
            .impacts = &frame.impacts};
}

// Sweeps colliders to the solved poses. True if contacts found there overlap.
bool refresh_contacts(const Solve& s, OldPoints old_points) {
    FrameGraph& frame = s.io.frame;
    const FoundContacts found = refresh_contacts(
        moving_contacts(s), {s.tuning.contact.margin_m, s.tuning.contact.sweep_m}, old_points);
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
                  [&](const Island& island) { return has_hand_or_joint(s.graph(), island); });
    // build_constraints wrote reached_ws of all other bodies.
    for (const std::uint32_t i : s.graph().island_bodies) {
        s.phase_of(i).reached_ws = s.graph().bodies[i].pose_ws;
    }
    refresh_contacts(s, OldPoints::replaced);
}

// True if the island pushes a player. Once it has begun to push it continues, even if the body that
// gave way is no longer at the wall.
bool pushes_player(const Solve& s, const Island& island) {
    return is_pushed(s.io.frame, island) || may_push(s.graph(), island);
}

// True if a heap overlaps deeply and may only come apart by pushing the player. A heap that touches
// nothing immovable can always give way, if not in this frame then in the next.
bool presses_player(const Solve& s, const Island& island) {
    return errors_of(s, island).heap_m > k_heap_violated_m && pushes_player(s, island);
}

// True if forward left a heap that presses the player (presses_player), so that relax must run.
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
               (errors.without_drives_m() > s.tuning.solver.positions.tolerance_m ||
                errors.heap_m > k_heap_slack_m);
    });
}

// Solves the heaps that forward could not solve with the hands kept at their targets: the held
// bodies give way, so that backward starts from a heap without overlap.
void relax(const Solve& s) {
    HH_DETAIL_ZONE("relax");
    const auto wanted = [&](const Island& island) { return presses_player(s, island); };
    // Marked before the heap gives way, because it may separate from the wall that it touches now.
    for (const Island& island : s.graph().islands) {
        if (wanted(island)) {
            mark_pushed(island, s.io.frame);
        }
    }
    solve_rounds(s, Phase::relax, wanted);
}

bool wants_backward(const Solve& s, const Island& island) {
    return errors_of(s, island).worst_m() > s.violated_m() && pushes_player(s, island);
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
        mark_pushed(island, s.io.frame);
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
        return is_pushed(s.io.frame, island) && errors_of(s, island).worst_m() > s.violated_m();
    };
    solve_rounds(s, Phase::backward, wanted);
    // The contacts that forward found may all be satisfied at the reach poses, so that nothing was
    // solved and swept. Sweep once more for other obstacles.
    if (refresh_contacts(s, OldPoints::kept)) {
        solve_rounds(s, Phase::backward, wanted);
    }
}

// Hands decide how held bodies move, not their impacts.
void restore_free_impacts(const Solve& s) {
    FrameGraph& frame = s.io.frame;
    std::erase_if(frame.impacts, [&](const ContactPoint& impact) {
        return std::ranges::any_of(std::array{impact.id_a, impact.id_b}, [&](std::uint64_t id) {
            const std::size_t body = find_body(frame.graph, id);
            return frame.graph.bodies[body].in_heap || frame.phase[body].held;
        });
    });
    if (!frame.impacts.empty()) {
        restore_impacts(moving_contacts(s), frame.impacts);
        activate_islands(frame);
        clear_errors(s);
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
        if (may_push(s.graph(), island)) {
            mark_pushed(island, s.io.frame);
        }
    }
    solve_rounds(s, Phase::contradiction, wanted);
}

}  // namespace

void solve_phases(const SolvePhasesIo& io, const Tuning& tuning, StageStats& stats) {
    solve_phases_with(&solve_positions, io, tuning, stats);
}

void solve_phases_with(PositionSolver solver, const SolvePhasesIo& io, const Tuning& tuning,
                       StageStats& stats) {
    const Solve s{solver, io, tuning, stats};
    io.frame.impacts.clear();
    clear_errors(s);
    count_heap_visits(s);
    activate_islands(io.frame);
    reach(s);
    forward(s);
    relax(s);
    backward(s);
    contradiction(s);
    restore_free_impacts(s);
    stats.islands += s.graph().islands.size();
}

}  // namespace handhold
