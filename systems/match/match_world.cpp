#include "systems/match/match_world.hpp"

#include <span>

#include "engine/core/hash.hpp"

namespace handhold {

void step_tick(const MatchWorld& match, const TickInputs& inputs, bool is_shown,
               TickScratch& scratch, StageStats& stats) {
    const double start_s = match.world.clock.t_s;
    const double end_s = start_s + match.dt_s;
    std::size_t count = 0;
    for (std::size_t slot = 0; slot < match.player_count; ++slot) {
        const Entity player = find_by_id(match.world, match.players[slot]);
        if (!match.world.player.contains(player)) {
            continue;
        }
        const MatchInput& now = *inputs.now[slot];
        scratch.samples[count] = unpack_samples(*inputs.before[slot], now, start_s, end_s);
        scratch.players[count] = {player, scratch.samples[count].view(), unpack_commands(now)};
        ++count;
    }
    const FrameInput input{match.dt_s, std::span(scratch.players).first(count)};
    if (match.host.step != nullptr) {
        match.host.step(match.host.context, input, inputs, is_shown);
    } else if (is_shown) {
        step_frame(match.world, match.caches, match.tuning, input, stats);
    } else {
        step_simulated(match.world, match.caches, match.tuning, input, stats);
    }
}

std::uint64_t hash_of_host(const MatchWorld& match) {
    return match.host.hash != nullptr ? match.host.hash(match.host.context) : 0;
}

std::uint64_t match_hash(const MatchWorld& match, std::uint64_t world_hash,
                         std::uint64_t host_hash) {
    if (match.host.hash == nullptr) {
        return world_hash;
    }
    HashStream hash;
    hash.add(world_hash);
    hash.add(host_hash);
    return hash.value();
}

}  // namespace handhold
