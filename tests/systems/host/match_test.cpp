// Matches over the C interface: world and game are equal on all machines, and packets are hostile.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/host/match_table.hpp"

namespace handhold::host_match_test {
namespace {

using match_test::seed_of;
using test::TableMachine;
using test::TableMatch;

const lab::NetworkTraits k_lossy{
    .delay_s = 0.05, .jitter_s = 0.03, .loss = 0.05, .duplication = 0.05};

std::uint64_t refused_of(const hh_match_stats& stats) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : stats.refused) {
        sum += count;
    }
    return sum;
}

// Fails unless the run did what it is about.
void expect_it_happened(const TableMatch& table, std::uint64_t compared) {
    EXPECT_GT(table.compared, compared);
    EXPECT_GT(table.server.game.state.score, 8U);
    EXPECT_GT(table.server.game.state.opened, 2U);
    EXPECT_GT(table.retracted, 0U);
    const auto has = [&](hh_event_kind kind) {
        return std::ranges::any_of(table.server_events, [kind](const test::EventKey& key) {
            return std::get<1>(key) == kind;
        });
    };
    EXPECT_TRUE(has(HH_EVENT_GRABBED));
    EXPECT_TRUE(has(HH_EVENT_RELEASED));
    EXPECT_TRUE(has(HH_EVENT_CONTACT_BEGAN));
    EXPECT_TRUE(has(HH_EVENT_LIMIT_REACHED));
    EXPECT_TRUE(has(HH_EVENT_TOUCHED));
}

TEST(HostMatch, WorldAndGameAreEqualOverALossyNetwork) {
    TableMatch table(k_lossy, 31);
    table.play(6.0);
    expect_it_happened(table, 800);
    EXPECT_GT(table.network.lost(), 50);
    EXPECT_EQ(table.server.match.stats().out_of_sync, 0U);
    EXPECT_GT(table.server.match.stats().hashes, 6U);
    for (const auto& client : table.clients) {
        const hh_match_stats stats = client->match.stats();
        EXPECT_GT(stats.rollbacks, 100U);
        EXPECT_GT(stats.steps_again, stats.rollbacks);
        EXPECT_GT(stats.tick, table.server.match.stats().tick);
        EXPECT_EQ(stats.waits, 0U);
    }
    EXPECT_FALSE(*table.server.match.needs_state(0));
    EXPECT_FALSE(*table.clients[1]->match.needs_state(1));
}

// Each event of a confirmed tick comes once as confirmed, on every machine. Each predicted one is
// confirmed or retracted later; TableMatch checks that no other one is.
TEST(HostMatch, EventsAreConfirmedOnceAndRetractedWhereTheyDidNotHappen) {
    TableMatch table(k_lossy, 32);
    table.play(6.0);
    expect_it_happened(table, 800);
    for (std::size_t seat = 0; seat < test::k_seats; ++seat) {
        const std::uint64_t until = table.clients[seat]->match.stats().confirmed;
        std::vector<test::EventKey> expected;
        std::ranges::copy_if(
            table.server_events, std::back_inserter(expected),
            [until](const test::EventKey& key) { return std::get<0>(key) <= until; });
        EXPECT_GT(expected.size(), 30U);
        std::vector<test::EventKey> found = table.confirmed[seat];
        found.resize(std::min(found.size(), expected.size()));
        EXPECT_EQ(found, expected);
        for (const auto& [key, count] : table.predicted[seat]) {
            EXPECT_TRUE(count == 0 || std::get<0>(key) > until) << std::get<0>(key);
        }
    }
}

TEST(HostMatch, PlayersWhoJoinLateOrAgainHaveWorldAndGame) {
    TableMatch table(k_lossy, 33, 1);
    test::Random random(seed_of(34));
    table.play(2.0);
    table.join(1);
    table.play(1.5);
    for (int i = 0; i < 6; ++i) {
        table.join(1, random.between(0.0, 0.3));
        table.play(random.between(0.2, 0.9));
    }
    table.play(2.0);
    expect_it_happened(table, 800);
    EXPECT_EQ(table.server.match.stats().out_of_sync, 0U);
    EXPECT_EQ(table.clients[1]->match.stats().refused[HH_MATCH_REFUSED_STATE], 0U);
    EXPECT_GT(table.checked_until[1], table.joined_at[1] + 90);
}

// A match with `plant`, in which the first difference is looked for.
hh_match_difference first_difference(const auto& plant, int ticks) {
    TableMachine machine(HH_MATCH_SYNC_TEST);
    plant(machine);
    for (int i = 0; i < ticks; ++i) {
        const double end_s = machine.scene.world.time_s() + test::k_step_s;
        std::array<hh::Sample, test::k_seats> samples;
        std::array<hh_match_input, test::k_seats> inputs;
        for (std::size_t seat = 0; seat < test::k_seats; ++seat) {
            samples[seat] = test::table_sample(seat, end_s);
            inputs[seat] = hh::match_input({&samples[seat], 1}, test::table_buttons(seat, end_s));
        }
        const hh::Maybe<hh_match_difference> found = machine.match.sync_test(inputs);
        EXPECT_TRUE(found);
        if (found->tick != 0) {
            return *found;
        }
    }
    EXPECT_GT(machine.game.state.score, 2U);
    EXPECT_GT(machine.game.state.opened, 0U);
    EXPECT_GT(machine.match.stats().steps_again, static_cast<std::uint64_t>(7 * ticks));
    return {};
}

TEST(HostMatch, SyncTestFindsWhatAGameForgetsToRestore) {
    const hh_match_difference good = first_difference([](TableMachine&) {}, 300);
    EXPECT_EQ(good.tick, 0U);
    const hh_match_difference in_game =
        first_difference([](TableMachine& machine) { machine.plants_in_game = true; }, 60);
    EXPECT_GT(in_game.tick, 0U);
    EXPECT_TRUE(in_game.in_game);
    EXPECT_FALSE(in_game.in_world);
    const hh_match_difference in_world =
        first_difference([](TableMachine& machine) { machine.plants_in_world = true; }, 60);
    EXPECT_GT(in_world.tick, 0U);
    EXPECT_TRUE(in_world.in_world);
}

// Every bad packet is one error and one count; the players' own packets are not affected.
TEST(HostMatch, BadPacketsAreOneErrorEachAndLoseNothing) {
    const lab::NetworkTraits traits{.delay_s = 0.04, .jitter_s = 0.02};
    TableMatch calm(traits, 35);
    calm.play(3.0);
    TableMatch attacked(traits, 35);
    attacked.records = true;
    test::Random random(seed_of(36));
    std::uint64_t bad = 0;
    std::uint64_t replayed = 0;
    const auto number_below = [&](std::size_t most) {
        const double number = random.between(0.0, static_cast<double>(most));
        return std::min(static_cast<std::size_t>(number), most - 1);
    };
    for (int i = 0; i < 270; ++i) {
        attacked.play(test::k_step_s);
        const std::size_t sent = attacked.recorded.size();
        if (sent < 200) {
            continue;
        }
        const auto expect_error = [&](std::span<const std::byte> packet, std::uint32_t slot) {
            hh::Match& server = attacked.server.match;
            const std::uint64_t before = refused_of(server.stats());
            EXPECT_EQ(server.receive_from(slot, attacked.now_s, packet).result(), HH_ERROR_DATA);
            EXPECT_EQ(refused_of(server.stats()), before + 1);
            EXPECT_NE(std::string(hh_last_error()).find("packet"), std::string::npos);
            EXPECT_EQ(attacked.clients[0]->match.receive(packet).result(), HH_ERROR_DATA);
            ++bad;
        };
        std::vector<std::byte> packet = attacked.recorded[sent - 1 - number_below(100)];
        const std::uint32_t slot = std::to_integer<std::uint32_t>(packet[1]) & 15U;
        expect_error(std::span(packet).first(number_below(packet.size())), slot);  // truncated
        expect_error(packet, 1 - slot);                                            // of another
        // Of long ago: nothing in it is new.
        const std::vector<std::byte>& old = attacked.recorded[sent - 100 - number_below(100)];
        const std::uint32_t old_slot = std::to_integer<std::uint32_t>(old[1]) & 15U;
        EXPECT_TRUE(attacked.server.match.receive_from(old_slot, attacked.now_s, old));
        ++replayed;
        packet[number_below(packet.size())] ^= static_cast<std::byte>(1U << (i % 8));  // flipped
        expect_error(packet, slot);
        std::vector<std::byte> noise(number_below(1400));
        for (std::byte& byte : noise) {
            byte = static_cast<std::byte>(number_below(256));
        }
        expect_error(noise, slot);
        const std::uint64_t tick = attacked.server.match.stats().tick;
        EXPECT_EQ(attacked.clients[0]->match.join(noise).result(), HH_ERROR_DATA);
        EXPECT_EQ(attacked.server.match.stats().tick, tick);
    }
    EXPECT_GT(bad, 600U);
    EXPECT_GT(replayed, 150U);
    const std::uint64_t last =
        std::min(calm.server.match.stats().tick, attacked.server.match.stats().tick);
    EXPECT_GT(last, 260U);
    EXPECT_EQ(attacked.server_hash(last), calm.server_hash(last));
}

TEST(HostMatch, RefusesWhatItCannotDo) {
    TableMatch table(k_lossy, 37);
    table.play(0.5);
    TableMachine& client = *table.clients[0];
    hh_world* const world = client.scene.world.get();
    EXPECT_EQ(hh_world_step(world, 0.01, nullptr, 0), HH_ERROR_STATE);
    EXPECT_EQ(hh_world_step_simulated(world, 0.01, nullptr, 0), HH_ERROR_STATE);
    EXPECT_EQ(hh_world_step_pose_only(world, 0.01, nullptr, 0), HH_ERROR_STATE);
    EXPECT_EQ(hh_world_begin_step(world, 0.01, nullptr, 0), HH_ERROR_STATE);
    EXPECT_EQ(hh_world_restore(world, "x", 1), HH_ERROR_STATE);
    hh_world_destroy(world);  // refused
    std::uint64_t hash = 0;
    EXPECT_EQ(hh_world_hash(world, &hash), HH_OK);
    hh_match_def def = hh::match_def();
    hh_match* made = nullptr;
    EXPECT_EQ(hh_match_create(world, &def, nullptr, &made), HH_ERROR_STATE);
    EXPECT_EQ(hh_match_confirm(client.match.get(), 1.0, nullptr), HH_ERROR_STATE);
    EXPECT_EQ(hh_match_connect(client.match.get(), 0), HH_ERROR_STATE);
    EXPECT_EQ(hh_match_connect(table.server.match.get(), 2), HH_ERROR_VALUE);
    EXPECT_EQ(hh_match_hash(client.match.get(), 1U << 20U, &hash), HH_ERROR_VALUE);
    std::array<std::byte, 100> small{};
    std::size_t size = 0;
    EXPECT_EQ(hh_match_packet(client.match.get(), small.data(), small.size(), &size),
              HH_ERROR_CAPACITY);
    EXPECT_EQ(size, std::size_t{HH_MATCH_PACKET_BYTES});
    EXPECT_EQ(hh_match_state(table.server.match.get(), 0, small.data(), small.size(), &size),
              HH_ERROR_CAPACITY);
    EXPECT_GT(size, 1000U);
    EXPECT_EQ(hh_match_receive(nullptr, small.data(), 4), HH_ERROR_NULL);
    hh::World other;
    const auto refused = [&](hh_result expected) {
        EXPECT_EQ(hh_match_create(other.get(), &def, nullptr, &made), expected);
        EXPECT_EQ(made, nullptr);
        def = hh::match_def();
    };
    refused(HH_ERROR_VALUE);  // no players
    def.player_count = 1;
    refused(HH_ERROR_NULL);
    const hh_player nobody{7, 7};
    def.players = &nobody;
    def.player_count = 1;
    refused(HH_ERROR_HANDLE);
    def.players = &nobody;
    def.player_count = 17;
    refused(HH_ERROR_VALUE);
    def.struct_size = 1;
    refused(HH_ERROR_VERSION);
    table.play(0.5);  // nothing of this has changed anything
    EXPECT_EQ(table.server.match.stats().out_of_sync, 0U);
}

}  // namespace
}  // namespace handhold::host_match_test
