// Matches over simulated networks: every confirmed tick is equal on all machines, bit for bit.
#include <array>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/parallel.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/match/match_play.hpp"

namespace handhold::match_test {
namespace {

std::uint64_t sum_of(const RefusalCounts& refused) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : refused) {
        sum += count;
    }
    return sum;
}

TEST(MatchSessions, ConfirmedTicksAreEqualOnAllMachines) {
    const std::array<NetworkTraits, 4> networks = {
        NetworkTraits{.delay_s = 0.02, .jitter_s = 0.005},
        NetworkTraits{.delay_s = 0.075, .jitter_s = 0.04, .loss = 0.05},
        NetworkTraits{.delay_s = 0.1, .jitter_s = 0.06, .loss = 0.1, .duplication = 0.1},
        NetworkTraits{.delay_s = 0.05, .jitter_s = 0.03, .loss = 0.02, .burst_loss = 0.02}};
    std::uint64_t filled = 0;
    int lost = 0;
    int doubled = 0;
    int overtaken = 0;
    for (std::size_t i = 0; i < networks.size(); ++i) {
        SCOPED_TRACE("network " + std::to_string(i));
        MatchPlay match(networks[i], 100 + i);
        match.play(2.0);
        const std::uint64_t at_first = match.server.counts().filled;
        match.play(4.0);
        match.expect_it_happened();
        EXPECT_GE(match.server.confirmed(), 535U);
        EXPECT_GT(match.server.counts().hashes, 8U);
        EXPECT_EQ(match.server.counts().out_of_sync, 0U);
        for (const auto& machine : match.machines) {
            EXPECT_EQ(machine->session.counts().waits, 0U);
            EXPECT_GT(machine->session.now(), match.server.confirmed());
            EXPECT_FALSE(machine->session.needs_state());
        }
        filled += match.server.counts().filled - at_first;
        lost += match.network.lost();
        doubled += match.network.doubled();
        overtaken += match.network.overtaken();
    }
    EXPECT_GT(filled, 5U);
    EXPECT_GT(lost, 100);
    EXPECT_GT(doubled, 50);
    EXPECT_GT(overtaken, 500);
}

// On a quiet network nearly every input is real once the players have found their lead.
void expect_inputs_in_time(int frames_a_packet) {
    MatchPlay match({.delay_s = 0.075, .jitter_s = 0.04, .loss = 0.05}, 7);
    match.frames_a_packet = frames_a_packet;
    match.play(2.0);
    const std::uint64_t before = match.server.counts().filled;
    match.play(6.0);
    const double share = static_cast<double>(match.server.counts().filled - before) /
                         (6.0 * 90.0 * static_cast<double>(k_people));
    EXPECT_LE(share, 0.005);
    for (const auto& machine : match.machines) {
        // The lead is the way to the server, not more than needed.
        EXPECT_LE(machine->session.now() - match.server.confirmed(), 30U);
    }
    match.expect_it_happened();
}

TEST(MatchSessions, OwnInputsArriveInTimeOnceTheLeadIsFound) { expect_inputs_in_time(1); }

TEST(MatchSessions, InputsOfTwoTicksAPacketArriveInTime) { expect_inputs_in_time(2); }

// A player who freezes for two seconds delays nobody, is away meanwhile, and comes back.
TEST(MatchSessions, FrozenPlayerDelaysNobodyAndComesBack) {
    MatchPlay match({.delay_s = 0.05, .jitter_s = 0.02, .loss = 0.02}, 8);
    match.play(2.5);
    Machine& frozen = *match.machines[2];
    frozen.is_frozen = true;
    std::array<std::uint64_t, k_people> before{};
    for (std::size_t i = 0; i < k_people; ++i) {
        before[i] = match.machines[i]->session.counts().ticks;
    }
    match.play(2.0);
    for (const std::size_t i : {0U, 1U, 3U}) {
        EXPECT_NEAR(static_cast<double>(match.machines[i]->session.counts().ticks - before[i]),
                    180.0, 6.0);
        EXPECT_EQ(match.machines[i]->session.counts().waits, 0U);
    }
    EXPECT_GT(match.server.counts().filled, 160U);
    frozen.is_frozen = false;
    match.play(3.0);
    EXPECT_GT(frozen.session.now() + 2, match.server.confirmed());
    EXPECT_GT(frozen.session.confirmed() + 30, match.server.confirmed());
    EXPECT_LE(frozen.session.now() - match.server.confirmed(), 30U);  // not more than needed
    const std::uint64_t filled = match.server.counts().filled;
    match.play(1.0);
    EXPECT_LE(match.server.counts().filled - filled, 5U);  // in time again
    EXPECT_EQ(match.server.counts().out_of_sync, 0U);
    match.expect_it_happened();
}

TEST(MatchSessions, LateJoinerIsEqualFromTheFirstTick) {
    MatchPlay match({.delay_s = 0.05, .jitter_s = 0.02, .loss = 0.05}, 9, k_people - 1);
    match.play(3.0);
    constexpr std::size_t k_late = k_people - 1;
    match.bring_state(k_late);
    match.machines[k_late]->is_here = true;
    match.server.connect(k_late);
    const std::uint64_t compared = match.counts.compared;
    match.play(4.0);
    EXPECT_GT(match.counts.compared - compared, 1200U);
    EXPECT_GT(match.machines[k_late]->session.now(), match.server.confirmed());
    EXPECT_LE(match.machines[k_late]->session.now() - match.server.confirmed(), 30U);
    EXPECT_EQ(match.server.counts().out_of_sync, 0U);
    EXPECT_GT(match.server.inputs_of(k_late).last_real(), 600U);
    match.expect_it_happened();
}

// A dropped player's hands let go and the body floats; nobody waits. Another connection takes over.
TEST(MatchSessions, DroppedPlayerLetsGoAndMayReturn) {
    MatchPlay match({.delay_s = 0.04, .jitter_s = 0.02}, 10);
    match.play(2.0);
    constexpr std::size_t k_dropped = 2;
    const auto holds = [&] { return !match.server_world().body_hold.empty(); };
    ASSERT_TRUE(holds());
    match.machines[k_dropped]->is_here = false;
    match.server.disconnect(k_dropped);
    match.play(1.6);
    EXPECT_FALSE(holds());
    for (const std::size_t i : {0U, 1U, 3U}) {
        EXPECT_EQ(match.machines[i]->session.counts().waits, 0U);
    }
    match.bring_state(k_dropped);
    match.machines[k_dropped]->is_here = true;
    match.server.connect(k_dropped);
    match.play(2.0);
    EXPECT_GT(match.server.inputs_of(k_dropped).last_real() + 10, match.server.confirmed());
    EXPECT_EQ(match.server.counts().out_of_sync, 0U);
}

// A player joins again and again without ever being disconnected: inputs of the connection before
// are on their way, and some are ahead of the confirmed tick that the state is of.
TEST(MatchSessions, PlayersWhoJoinAgainWhileConnectedStayEqual) {
    MatchPlay match({.delay_s = 0.05, .jitter_s = 0.03, .loss = 0.05, .duplication = 0.05}, 16);
    test::Random random(seed_of(17));
    int with_inputs_ahead = 0;
    match.play(1.5);
    for (int i = 0; i < 12; ++i) {
        const std::size_t person = random.between(0.0, 1.0) < 0.5 ? 1 : 2;
        const std::vector<std::byte> state = match.send_state(person);
        with_inputs_ahead +=
            match.server.inputs_of(person).final_until() > match.server.confirmed() ? 1 : 0;
        match.play(i % 3 == 0 ? 0.0 : random.between(0.0, 0.4));  // the state's way
        match.take_state(person, state);
        match.play(random.between(0.1, 1.2));
    }
    match.play(2.5);
    EXPECT_GE(with_inputs_ahead, 3);
    EXPECT_EQ(match.server.counts().out_of_sync, 0U);
    EXPECT_GT(match.server.counts().hashes, 10U);
    for (const auto& machine : match.machines) {
        EXPECT_FALSE(machine->session.needs_state());
        EXPECT_GT(machine->session.now(), match.server.confirmed());
        EXPECT_GT(machine->session.confirmed() + 30, match.server.confirmed());
    }
    match.expect_it_happened();
}

// A machine with another tuning computes another world: the hashes tell.
TEST(MatchSessions, WorldThatDiffersIsFound) {
    MatchPlay match({.delay_s = 0.03, .jitter_s = 0.01}, 11);
    match.play(1.5);
    Machine& broken = *match.machines[3];
    broken.scene.tuning.locomotion.drift_drag_per_s += 0.5;
    broken.is_compared = false;
    match.play(3.5);
    EXPECT_GT(match.server.counts().out_of_sync, 0U);
    EXPECT_TRUE(match.server.needs_state(3));
    EXPECT_TRUE(broken.session.needs_state());
}

// Without any packet from the server, a client stops before its window ends, and goes on
// afterwards.
TEST(MatchSessions, ClientWaitsAtTheEndOfItsWindow) {
    MatchPlay match({.delay_s = 0.03, .jitter_s = 0.01}, 12);
    match.play(1.0);
    match.network.set_traits({.delay_s = 0.03, .jitter_s = 0.01, .loss = 1.0});
    match.play(1.5);
    for (const auto& machine : match.machines) {
        EXPECT_GT(machine->session.counts().waits, 20U);
        EXPECT_LT(machine->session.now(), machine->session.confirmed() + ClientSession::k_window);
    }
    match.network.set_traits({.delay_s = 0.03, .jitter_s = 0.01});
    match.play(3.0);
    EXPECT_GT(match.counts.compared, 600U);
    for (const auto& machine : match.machines) {
        EXPECT_GT(machine->session.now(), match.server.confirmed());
        EXPECT_FALSE(machine->session.needs_state());
    }
}

TEST(MatchSessions, WarmFrameAllocatesNothing) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "the sanitizer has the allocator";
    }
    MatchPlay match({.delay_s = 0.05, .jitter_s = 0.02, .loss = 0.02}, 13);
    match.play(4.0);
    std::size_t in_session = 0;
    Machine& machine = *match.machines[0];
    std::array<std::byte, k_most_packet_bytes> packet{};
    const std::uint64_t rollbacks = machine.session.counts().rollbacks;
    for (int i = 0; i < 40; ++i) {
        match.play(k_tick_s);
        const MatchTick tick = machine.session.now() + 1;
        const MatchInput own = machine.own_input();
        machine.sent.resize(tick + 1);
        machine.sent[tick] = own;
        const std::size_t before = allocation_count();
        const std::size_t of_server = match.server.write_packet(0, packet);
        machine.session.receive(std::span(packet).first(of_server));
        machine.session.advance(own);
        const std::size_t size = machine.session.write_packet(packet);
        match.server.receive(0, std::span(packet).first(size), match.now_s);
        in_session += allocation_count() - before;
    }
    EXPECT_LE(in_session, 2U);  // a column may still meet its largest size
    EXPECT_GT(machine.session.counts().rollbacks, rollbacks + 20);
}

TEST(MatchSessionsThreaded, ThreadsChangeNoBit) {
    const auto hash_of = [](int threads) {
        set_thread_count(threads);
        MatchPlay match({.delay_s = 0.06, .jitter_s = 0.03, .loss = 0.05}, 14);
        match.play(2.0);
        set_thread_count(1);
        EXPECT_GT(match.counts.compared, 300U);
        return match.server_hash(170);
    };
    EXPECT_EQ(hash_of(4), hash_of(1));
}

TEST(MatchSessions, PacketsAreSmall) {
    MatchPlay match({.delay_s = 0.075, .jitter_s = 0.04, .loss = 0.05}, 15);
    match.play(3.0);
    match.records = true;
    match.play(3.0);
    std::array<double, 2> bytes{};  // of the server and of clients
    for (const auto& packet : match.recorded) {
        const bool is_client = (std::to_integer<unsigned>(packet[0]) & 7U) == 1;
        bytes[is_client ? 1 : 0] += static_cast<double>(packet.size());
    }
    const double per_s = 8.0 / 3.0 / static_cast<double>(k_people) / 1000.0;
    const double down_kbit = bytes[0] * per_s;
    const double up_kbit = bytes[1] * per_s;
    RecordProperty("up_kbit_per_s", std::to_string(up_kbit));
    RecordProperty("down_kbit_per_s", std::to_string(down_kbit));
    // Without headers of transport; hands of scripts have no tremor.
    EXPECT_LE(up_kbit, 60.0);
    EXPECT_LE(down_kbit, 120.0);
    EXPECT_EQ(
        sum_of(match.machines[0]->session.counts().refused),
        match.machines[0]->session.counts().refused[static_cast<std::size_t>(MatchRefusal::gap)]);
}

}  // namespace
}  // namespace handhold::match_test
