#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <handhold/match.hpp>

#include "tests/fuzz/promise.hpp"

// A small match whose messages fuzzers change.
namespace handhold::fuzz {

using FuzzBytes = std::vector<std::byte>;
inline constexpr std::uint32_t k_bed_players = 2;

struct BedWorld {
    hh::World world;
    std::vector<hh::Player> players;

    BedWorld() {
        hh_body_def wall = hh::body_def();
        wall.shape = *world.add_box({2.0, 2.0, 0.1});
        wall.pose.position = {0.0, 1.0, -0.6};
        (void)world.add(wall);
        for (std::uint32_t slot = 0; slot < k_bed_players; ++slot) {
            hh_player_def player = hh::player_def();
            player.origin.position.x = slot;
            players.push_back(*world.add(player));
            (void)world.use_wrists(players.back());
        }
    }
};

struct BedMachine {
    BedWorld bed;
    hh::Match match;

    explicit BedMachine(hh_match_role role, std::uint32_t slot = 0) {
        hh_match_def def = hh::match_def();
        def.role = role;
        def.slot = slot;
        match = hh::Match(bed.world, bed.players, def);
        promise(match.is_valid(), "the bed's match is valid");
    }
};

// Patches: two bytes of offset and one that is added to the byte there.
inline FuzzBytes patched_bytes(FuzzBytes bytes, Bytes patches) {
    while (patches.size() >= 3 && !bytes.empty()) {
        const std::size_t at =
            (std::size_t{patches[0]} | std::size_t{patches[1]} << 8U) % bytes.size();
        bytes[at] ^= static_cast<std::byte>(patches[2]);
        patches = patches.subspan(3);
    }
    return bytes;
}

// Examples of every message, of a match of 120 ticks with two players.
struct BedMessages {
    std::vector<FuzzBytes> of_clients;
    std::vector<FuzzBytes> of_server;
    std::vector<FuzzBytes> of_watched;
    std::vector<FuzzBytes> states;

    BedMessages() {
        BedMachine server(HH_MATCH_SERVER);
        std::array<BedMachine, k_bed_players> clients = {BedMachine(HH_MATCH_CLIENT, 0),
                                                         BedMachine(HH_MATCH_CLIENT, 1)};
        FuzzBytes bytes;
        std::uint64_t watched = 0;
        for (std::uint32_t slot = 0; slot < k_bed_players; ++slot) {
            (void)server.match.connect(slot);
        }
        for (int frame = 0; frame < 120; ++frame) {
            const double now_s = frame / 90.0;
            for (std::uint32_t slot = 0; slot < k_bed_players; ++slot) {
                BedMachine& client = clients[slot];
                hh::Sample sample = hh::sample();
                sample.time_s = client.bed.world.time_s() + 1.0 / 90.0;
                sample.head.position = {0.0, 1.6, 0.1 * std::sin(now_s)};
                sample.hands[0] = hh::pose_at({-0.2, 1.2, -0.4 + 0.1 * std::sin(7.0 * now_s)});
                sample.hands[1] = hh::pose_at({0.2, 1.2 + 0.1 * std::sin(5.0 * now_s), -0.4});
                sample.grab[1] = frame / 20 % 2 == 1 ? 1 : 0;
                (void)client.match.advance(hh::match_input({&sample, 1}));
                (void)client.match.packet(bytes);
                // The first player's packets are late at times: their inputs are filled.
                if (slot == 1 || frame % 30 < 24) {
                    (void)server.match.receive_from(slot, now_s, bytes);
                }
                add(bytes, frame, of_clients);
            }
            (void)server.match.confirm(now_s);
            for (std::uint32_t slot = 0; slot < k_bed_players; ++slot) {
                (void)server.match.packet_to(slot, bytes);
                (void)clients[slot].match.receive(bytes);
                add(bytes, frame, of_server);
            }
            if (frame % 40 == 39) {
                (void)server.match.confirmed_inputs(watched, bytes);
                of_watched.push_back(bytes);
            }
        }
        (void)server.match.state(0, bytes);
        states.push_back(bytes);
        (void)server.match.state_to_watch(bytes);
        states.push_back(bytes);
        promise(of_watched.size() == 3 && states[1].size() > 1000, "the bed has messages");
    }
    static const BedMessages& get() {
        static const BedMessages k_bed;
        return k_bed;
    }
    static const FuzzBytes& pick(const std::vector<FuzzBytes>& of, std::uint8_t number) {
        return of[number % of.size()];
    }

  private:
    static void add(const FuzzBytes& bytes, int frame, std::vector<FuzzBytes>& to) {
        if (frame % 15 == 0) {
            to.push_back(bytes);
        }
    }
};

}  // namespace handhold::fuzz
