// Matches of the C interface (handhold/match.h): sessions over a hh_world.
#include "systems/host/host_match.hpp"

#include <algorithm>
#include <cmath>

#include "systems/host/host_growth.hpp"
#include "systems/host/host_match_packets.hpp"
#include "systems/host/host_samples.hpp"
#include "systems/host/host_step.hpp"

namespace handhold {
namespace {

constexpr double k_shortest_tick_s = 1e-3;
constexpr double k_longest_tick_s = 0.1;
// Samples that are later than this after the tick's end are on another clock.
constexpr double k_farthest_sample_s = 0.5;
static_assert(HH_MATCH_PLAYERS == k_most_match_players);
static_assert(HH_MATCH_PACKET_BYTES == k_most_packet_bytes);
static_assert(HH_MATCH_INPUTS_BYTES == k_most_confirmed_bytes);
static_assert(HH_MATCH_PLACES == k_match_window);
static_assert(HH_MATCH_REFUSALS >= k_match_refusals);

void check_match_def(const hh_match_def& def) {
    require(def.player_count != 0, HH_ERROR_VALUE, "no players: a match has 1 to 16");
    require(def.player_count <= HH_MATCH_PLAYERS, HH_ERROR_VALUE, "a match has 1 to 16 players");
    require(def.players != nullptr, HH_ERROR_NULL, "the players are null");
    checked(def.tick_s, k_shortest_tick_s, k_longest_tick_s, "tick_s must lie in [1e-3, 0.1]");
    require(std::isfinite(def.start_s), HH_ERROR_VALUE, "start_s is not a number");
    require(def.role == HH_MATCH_CLIENT || def.role == HH_MATCH_SERVER ||
                def.role == HH_MATCH_SYNC_TEST || def.role == HH_MATCH_SPECTATOR,
            HH_ERROR_VALUE, "a role is client, server, sync test or spectator");
    require(def.role != HH_MATCH_CLIENT || def.slot < def.player_count, HH_ERROR_VALUE,
            "the slot is not below player_count");
    require(def.role != HH_MATCH_SYNC_TEST ||
                (def.sync_ticks >= 1 && def.sync_ticks + 2 <= k_match_window),
            HH_ERROR_VALUE, "sync_ticks must lie in [1, 62]");
}

MatchWorld match_world_of(hh_match& match) {
    hh_world& host = match.host;
    require(host.world.clock.frame <= k_last_start_tick, HH_ERROR_STATE,
            "a match begins before tick 2^32");
    MatchWorld out{.world = host.world,
                   .caches = host.caches,
                   .tuning = host.tuning,
                   .dt_s = match.def.tick_s,
                   .player_count = match.def.player_count,
                   .host = host_of(match)};
    for (std::size_t slot = 0; slot < match.def.player_count; ++slot) {
        const Entity player = player_of(host, match.def.players[slot]);
        out.players[slot] = host.world.persistent_id.at(player);
        const auto before = std::span(out.players).first(slot);
        require(std::ranges::find(before, out.players[slot]) == before.end(), HH_ERROR_VALUE,
                "a player has two slots");
    }
    return out;
}

// The input of the next tick, from devices that may have another rate.
MatchInput take_input(hh_match& match, std::size_t slot, const hh_match_input& input) {
    require(input.sample_count == 0 || input.samples != nullptr, HH_ERROR_NULL,
            "an input's samples are null");
    constexpr std::size_t k_most_samples = 1U << 16U;
    require(input.sample_count <= k_most_samples, HH_ERROR_VALUE,
            "an input has more than 2^16 samples");
    const double start_s = match.host.world.clock.t_s;
    const double end_s = start_s + match.def.tick_s;
    for (std::size_t i = 0; i < input.sample_count; ++i) {
        exact_sample(input.samples, i);  // nothing changes if one is of another version
    }
    for (std::size_t i = 0; i < input.sample_count; ++i) {
        const TrackingSample sample = exact_sample(input.samples, i);
        if (sample.t_s <= end_s + k_farthest_sample_s) {  // false for NaN
            match.samplers[slot].add(sample);
        }
    }
    return match.samplers[slot].take(start_s, end_s, read_commands(input.commands), input.buttons);
}

hh_match_stats stats_of(const hh_match& match) {
    hh_match_stats stats = hh_default_match_stats();
    stats.tick = match.host.world.clock.frame;
    stats.confirmed = stats.tick;
    RefusalCounts refused{};
    if (match.client != nullptr) {
        const ClientCounts& counts = match.client->counts();
        stats.confirmed = match.client->final_state();
        stats.ticks = counts.ticks;
        stats.rollbacks = counts.rollbacks;
        stats.steps_again = counts.steps_again;
        stats.deepest = counts.deepest;
        stats.waits = counts.waits;
        stats.filled = counts.filled;
        refused = counts.refused;
    } else if (match.server != nullptr) {
        const ServerCounts& counts = match.server->counts();
        stats.ticks = counts.ticks;
        stats.filled = counts.filled;
        stats.hashes = counts.hashes;
        stats.out_of_sync = counts.out_of_sync;
        refused = counts.refused;
    } else if (match.spectator != nullptr) {
        const SpectatorCounts& counts = match.spectator->counts();
        stats.ticks = counts.ticks;
        stats.hashes = counts.hashes;
        stats.out_of_sync = counts.out_of_sync;
        refused = counts.refused;
    } else {
        stats.ticks = match.sync->ticks();
        stats.rollbacks = match.sync->ticks();
        stats.steps_again = match.sync->steps_again();
        stats.deepest = std::min<std::uint64_t>(match.def.sync_ticks, stats.ticks);
    }
    std::ranges::copy(refused, std::begin(stats.refused));
    return stats;
}

}  // namespace

hh_match& match_of(hh_match* match) {
    require(match != nullptr, HH_ERROR_NULL, "the match is null");
    require(!match->is_in_game, HH_ERROR_STATE, "a function of the match's game is running");
    world_of(&match->host);  // not inside a surface query
    return *match;
}

const hh_match& match_of(const hh_match* match) {
    require(match != nullptr, HH_ERROR_NULL, "the match is null");
    require(!match->is_in_game, HH_ERROR_STATE, "a function of the match's game is running");
    return *match;
}

ClientSession& client_of(hh_match* match) {
    require(match_of(match).client != nullptr, HH_ERROR_STATE, "the match is not a client's");
    return *match->client;
}

ServerSession& server_of(hh_match* match) {
    require(match_of(match).server != nullptr, HH_ERROR_STATE, "the match is not a server's");
    return *match->server;
}

}  // namespace handhold

using namespace handhold;

namespace {

// Clients and spectators.
void require_no_server(hh_match* match) {
    const hh_match& of_host = match_of(match);
    require(of_host.client != nullptr || of_host.spectator != nullptr, HH_ERROR_STATE,
            "the match is neither a client's nor a spectator's");
}

void advance_client(hh_match& match, const hh_match_input& input, std::uint8_t& advanced) {
    ClientSession& client = *match.client;
    const MatchInput own = take_input(match, match.def.slot, input);
    match.events.clear();
    advanced = client.advance(own, input.is_hidden == 0) ? 1 : 0;
    confirm_events(match, client.final_state());
}

}  // namespace

hh_match::hh_match(hh_world& of_world, const hh_match_def& wanted, const hh_match_game& of_game)
    : host(of_world), def(wanted), game(of_game) {
    const MatchWorld world = match_world_of(*this);
    confirmed_events = host.world.clock.frame;
    if (def.role == HH_MATCH_SERVER) {
        server = std::make_unique<ServerSession>(world, def.start_s);
    } else if (def.role == HH_MATCH_CLIENT) {
        client = std::make_unique<ClientSession>(world, def.slot);
    } else if (def.role == HH_MATCH_SPECTATOR) {
        spectator = std::make_unique<SpectatorSession>(world);
    } else {
        sync = std::make_unique<SyncTest>(world, def.sync_ticks);
    }
    if (goes_back()) {
        // More events than a tick usually has: ticks allocate nothing from the start.
        constexpr std::size_t k_usual_events = 32;
        reports.resize(k_match_window);
        told.resize(k_match_window);
        for (std::size_t place = 0; place < k_match_window; ++place) {
            reports[place].contacts.reserve(k_usual_events);
            told[place].events.reserve(k_usual_events);
        }
        matched.reserve(k_usual_events);
    }
    def.players = nullptr;  // the host's array
    host.world.early_samples.clear();
    forget_events(host);
    host.is_in_match = true;
}

hh_match::~hh_match() { host.is_in_match = false; }

hh_result hh_default_match_def_sized(hh_match_def* filled, size_t size) {
    hh_match_def def{};
    def.tick_s = 1.0 / 90.0;
    def.sync_ticks = 8;
    return write_default(filled, size, def);
}

hh_result hh_default_match_game_sized(hh_match_game* filled, size_t size) {
    return write_default(filled, size, hh_match_game{});
}

hh_result hh_default_match_input_sized(hh_match_input* filled, size_t size) {
    return write_default(filled, size, hh_match_input{});
}

hh_result hh_default_match_stats_sized(hh_match_stats* filled, size_t size) {
    return write_default(filled, size, hh_match_stats{});
}

hh_result hh_match_create(hh_world* world, const hh_match_def* def, const hh_match_game* game,
                          hh_match** match) {
    return call([&] {
        hh_world& host = world_of(world);
        require(match != nullptr, HH_ERROR_NULL, "the output is null");
        require_idle(host);
        require_no_match(host);
        const hh_match_def read = read_def(def, hh_default_match_def());
        const hh_match_game no_game = hh_default_match_game();
        const hh_match_game read_game = game != nullptr ? read_def(game, no_game) : no_game;
        check_match_def(read);
        require((read_game.save != nullptr) == (read_game.restore != nullptr), HH_ERROR_VALUE,
                "a game has save and restore, or neither");
        *match = std::make_unique<hh_match>(host, read, read_game).release();
    });
}

void hh_match_destroy(hh_match* match) {
    if (match != nullptr && (match->is_in_game || match->host.surfaces.is_asking())) {
        report_failure(HH_ERROR_STATE, "a match cannot be destroyed inside its own callbacks");
        return;
    }
    delete match;
}

hh_result hh_match_ticks_due(hh_match* match, double elapsed_s, uint32_t* ticks) {
    return call([&] {
        require_no_server(match);
        require(ticks != nullptr, HH_ERROR_NULL, "the output is null");
        require(std::isfinite(elapsed_s), HH_ERROR_VALUE, "elapsed_s is not a number");
        const int due = match->spectator != nullptr ? match->spectator->ticks_due(elapsed_s)
                                                    : match->client->ticks_due(elapsed_s);
        *ticks = static_cast<std::uint32_t>(due);
    });
}

hh_result hh_match_advance(hh_match* match, const hh_match_input* input, uint8_t* advanced) {
    return call([&] {
        require_no_server(match);
        require(advanced != nullptr, HH_ERROR_NULL, "the output is null");
        const hh_match_input read = read_def(input, hh_default_match_input());
        if (match->spectator != nullptr) {
            match->events.clear();
            *advanced = match->spectator->advance(read.is_hidden == 0) ? 1 : 0;
        } else {
            advance_client(*match, read, *advanced);
        }
        // Also while the world waits: everything then stands still at its tick.
        if (read.is_hidden == 0) {
            note_drawn(*match);
        }
    });
}

hh_result hh_match_receive(hh_match* match, const void* packet, size_t size) {
    return call([&] {
        require_no_server(match);
        take_packet(packet, size, [&](std::span<const std::byte> bytes) {
            return match->spectator != nullptr ? match->spectator->receive(bytes)
                                               : match->client->receive(bytes);
        });
    });
}

hh_result hh_match_packet(hh_match* match, void* buffer, size_t capacity, size_t* size) {
    return call([&] {
        ClientSession& client = client_of(match);
        give_packet(buffer, capacity, size,
                    [&](std::span<std::byte> bytes) { return client.write_packet(bytes); });
    });
}

hh_result hh_match_join(hh_match* match, const void* bytes, size_t size) {
    return call([&] {
        require_no_server(match);
        require(bytes != nullptr, HH_ERROR_NULL, "the bytes are null");
        hh_world& host = match->host;
        const std::span<const std::byte> state(static_cast<const std::byte*>(bytes), size);
        const auto error = match->spectator != nullptr
                               ? match->spectator->join(state, assets_of(host), missing_heads(host))
                               : match->client->join(state, assets_of(host), missing_heads(host));
        if (error) {
            throw HostError{HH_ERROR_DATA, error->message()};
        }
        match->drawn.forget();
    });
}

hh_result hh_match_sync_test(hh_match* match, const hh_match_input* inputs, size_t input_count,
                             hh_match_difference* difference) {
    return call([&] {
        require(match_of(match).sync != nullptr, HH_ERROR_STATE, "the match is not a sync test");
        require(difference != nullptr, HH_ERROR_NULL, "the output is null");
        require(input_count == match->def.player_count, HH_ERROR_VALUE, [&] {
            return "a sync test needs one input for each of the " +
                   std::to_string(match->def.player_count) + " slots, not " +
                   std::to_string(input_count);
        });
        require(inputs != nullptr, HH_ERROR_NULL, "the inputs are null");
        std::array<MatchInput, k_most_match_players> of_slots;
        for (std::size_t slot = 0; slot < input_count; ++slot) {
            const hh_match_input input = read_def_at(inputs, slot, hh_default_match_input());
            of_slots[slot] = take_input(*match, slot, input);
        }
        match->events.clear();
        const SyncDifference found = match->sync->advance(of_slots);
        *difference = {found.tick, static_cast<std::uint8_t>(found.in_world ? 1 : 0),
                       static_cast<std::uint8_t>(found.in_host ? 1 : 0)};
    });
}

hh_result hh_match_needs_state(const hh_match* match, uint32_t slot, uint8_t* needs) {
    return call([&] {
        const hh_match& of_host = match_of(match);
        require(needs != nullptr, HH_ERROR_NULL, "the output is null");
        if (of_host.spectator != nullptr) {
            *needs = of_host.spectator->needs_state() ? 1 : 0;
            return;
        }
        const std::size_t wanted = slot_of(of_host, slot);
        const bool is_needed = of_host.server != nullptr ? of_host.server->needs_state(wanted)
                               : of_host.client != nullptr
                                   ? of_host.client->needs_state() && wanted == of_host.def.slot
                                   : false;
        *needs = is_needed ? 1 : 0;
    });
}

hh_result hh_match_hash(const hh_match* match, uint64_t tick, uint64_t* hash) {
    return call([&] {
        const hh_match& of_host = match_of(match);
        require(hash != nullptr, HH_ERROR_NULL, "the output is null");
        const bool is_kept = of_host.client != nullptr ? of_host.client->has_state(tick)
                                                       : tick == of_host.host.world.clock.frame;
        require(is_kept, HH_ERROR_VALUE, "the state after this tick is not kept");
        *hash = of_host.client != nullptr   ? of_host.client->hash_at(tick)
                : of_host.server != nullptr ? of_host.server->hash()
                : of_host.sync != nullptr   ? of_host.sync->hash()
                                            : of_host.spectator->hash();
    });
}

hh_result hh_match_shown_offsets(const hh_match* match, uint32_t slot, hh_vec3* head, hh_vec3* left,
                                 hh_vec3* right) {
    return call([&] {
        const hh_match& of_host = match_of(match);
        require(head != nullptr && left != nullptr && right != nullptr, HH_ERROR_NULL,
                "an output is null");
        const std::size_t wanted = slot_of(of_host, slot);
        const PlayerPoints offset =
            of_host.client != nullptr ? of_host.client->shown_offsets()[wanted] : PlayerPoints{};
        *head = to_c(offset.head);
        *left = to_c(offset.hands[index_of(HandSide::left)]);
        *right = to_c(offset.hands[index_of(HandSide::right)]);
    });
}

hh_result hh_match_events_sized(const hh_match* match, const hh_match_event** events, size_t* count,
                                size_t event_size) {
    return call([&] {
        const hh_match& of_host = match_of(match);
        require(events != nullptr && count != nullptr, HH_ERROR_NULL, "an output is null");
        // The first version is this one.
        require_size<hh_match_event>(event_size);
        *events = of_host.events.data();
        *count = of_host.events.size();
    });
}

hh_result hh_match_get_stats(const hh_match* match, hh_match_stats* stats) {
    return call([&] { write_out(stats, stats_of(match_of(match))); });
}
