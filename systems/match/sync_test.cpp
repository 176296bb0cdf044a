#include "systems/match/sync_test.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace handhold {

SyncTest::SyncTest(const MatchWorld& match, std::size_t depth)
    : match_(match), depth_(depth), start_(match.world.clock.frame) {
    HH_CHECK(match.player_count > 0 && match.player_count <= k_most_match_players,
             "a match has 1 to 16 players", match.player_count);
    HH_CHECK(depth > 0 && depth + 2 <= k_match_window, "depth must lie in [1, 62]", depth);
}

std::uint64_t SyncTest::hash() const {
    return match_hash(match_, hash_simulated(match_.world), hash_of_host(match_));
}

void SyncTest::keep(Kept& kept) {
    kept.world.keep(match_.world);
    kept.world_hash = kept.world.hash();
    kept.host_hash = hash_of_host(match_);
    if (match_.host.keep != nullptr) {
        match_.host.keep(match_.host.context, now() % k_match_window);
    }
}

void SyncTest::step(bool is_shown) {
    const MatchTick tick = now() + 1;
    TickInputs inputs;
    for (std::size_t slot = 0; slot < match_.player_count; ++slot) {
        inputs.before[slot] = &at(tick - 1).inputs[slot];
        inputs.now[slot] = &at(tick).inputs[slot];
    }
    step_tick(match_, inputs, is_shown, scratch_, stats_);
}

SyncDifference SyncTest::advance(std::span<const MatchInput> inputs, bool is_shown) {
    if (!is_start_kept_) {
        is_start_kept_ = true;
        keep(at(now()));
    }
    std::ranges::copy(inputs.first(match_.player_count), at(now() + 1).inputs.begin());
    step(false);
    keep(at(now()));
    const MatchTick present = now();
    const MatchTick depth = std::min<MatchTick>(depth_, present - start_);
    const MatchTick first = present - depth;
    at(first).world.restore(match_.world);
    if (match_.host.restore != nullptr) {
        match_.host.restore(match_.host.context, first % k_match_window);
    }
    SyncDifference difference;
    while (now() < present) {
        step(is_shown && now() + 1 == present);
        ++steps_again_;
        const Kept& before = at(now());
        const bool in_world = hash_simulated(match_.world) != before.world_hash;
        const bool in_host = hash_of_host(match_) != before.host_hash;
        if (difference.tick == 0 && (in_world || in_host)) {
            difference = {now(), in_world, in_host};
        }
        keep(at(now()));
    }
    return difference;
}

}  // namespace handhold
