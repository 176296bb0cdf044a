#pragma once

#include <cstdint>

#include "tools/lab/holds_count.hpp"
#include "tools/lab/match_hands.hpp"
#include "tools/lab/match_network.hpp"
#include "tools/lab/measure.hpp"

namespace handhold::lab {

struct MatchRunOptions {
    MatchSetting setting;
    NetworkTraits network;  // the same in each direction
    double seconds = 30.0;
    double packets_per_tick = 1.0;  // 0.5: every other tick, in both directions
    std::uint64_t seed = 1;
};

// Figures of a match. Times are CPU times of the calling thread; of the wall clock with more than
// one.
struct MatchFigures {
    std::uint64_t ticks = 0;  // sum over all clients
    std::uint64_t confirmed_ticks = 0;
    // Confirmed ticks of clients whose hash was compared with the server's, and those that
    // differed.
    std::uint64_t hashes_compared = 0;
    std::uint64_t hashes_different = 0;
    std::uint64_t stalls = 0;  // ticks that a client had to wait
    std::uint64_t filled = 0;  // inputs that came too late, after the first two seconds
    std::uint64_t asked = 0;   // inputs that were needed then
    HoldsCount holds;          // counted in the server's world
    Series rollback_ticks;     // depth of each rollback
    Series rollback_us;        // such a tick, with the steps again and the shown step
    Series client_tick_us;     // every tick of a client, with its packets
    Series server_tick_us;     // every confirmed tick, with its packets to all
    Series up_kbps;            // each client over each second, with headers
    Series down_kbps;          // likewise, to each client
    Series input_bytes;
    // State age: how old the newest real input of another player is that a tick used, s.
    Series others_age_s;
    Series others_hand_m;  // tracked hands of others, as first stepped, against the final ones
    // Motion in a tick beyond the true one, as stepped and with ShownOffsets. The own view: while
    // somebody else holds the same body too, and at other times.
    Series own_view_shared_raw_m;
    Series own_view_shared_m;
    Series own_view_raw_m;
    Series own_view_m;
    Series others_jump_raw_m;  // hands of others
    Series others_jump_m;
    Series others_shown_m;  // drawn hands of others, against the final ones
    std::uint64_t largest_packet = 0;
};

// A server and the peers, each with a world of its own, over a simulated network. The first two
// seconds, in which players find their lead, are in no series.
MatchFigures run_match(const MatchRunOptions& options);

}  // namespace handhold::lab
