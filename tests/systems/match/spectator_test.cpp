// Confirmed inputs: who watches a match, or plays a recording of it, has the server's world.
#include <array>
#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "systems/match/spectator_session.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/random.hpp"
#include "tests/systems/match/match_play.hpp"

namespace handhold::match_test {
namespace {

using Packet = std::vector<std::byte>;

// A machine that watches; its packets may be late, twice or missing.
struct Watcher {
    MatchScene scene;
    SpectatorSession session;
    MatchTick sent_until = 0;

    Watcher() : session(scene.match()) {}

    void join(const MatchPlay& match, const ShapeLibrary& shapes) {
        std::vector<std::byte> state;
        match.server.write_state_to_watch(SnapshotAssets(shapes), state);
        const auto error = session.join(state, SnapshotAssets(scene.shapes));
        ASSERT_FALSE(error) << error->message();
        sent_until = session.now();
    }
    // Steps what has come, and expects the server's hashes.
    void step(const MatchPlay& match, std::uint64_t& compared) {
        while (session.advance(false)) {
            ASSERT_EQ(session.hash(), match.server_hash(session.now())) << session.now();
            ++compared;
        }
    }
};

template <typename Session>
Packet packet_after(const Session& session, MatchTick after, MatchTick& until) {
    Packet packet(k_most_confirmed_bytes);
    packet.resize(session.write_watched(after, until, packet));
    return packet;
}

TEST(Spectators, EveryConfirmedTickIsEqualFromTheStartAndForLateJoiners) {
    MatchPlay match({.delay_s = 0.075, .jitter_s = 0.04, .loss = 0.05}, 21);
    Watcher first;
    Watcher late;
    const ShapeLibrary& shapes = first.scene.shapes;  // equal on all machines
    std::uint64_t compared = 0;
    std::uint64_t of_late = 0;
    for (int round = 0; round < 120; ++round) {
        match.play(0.05);
        if (round == 60) {
            late.join(match, shapes);
            ASSERT_GT(late.session.now(), 200U);
        }
        ASSERT_TRUE(match.server.can_write_after(first.sent_until));
        (void)first.session.receive(packet_after(match.server, first.sent_until, first.sent_until));
        first.step(match, compared);
        if (round >= 60) {
            (void)late.session.receive(
                packet_after(match.server, late.sent_until, late.sent_until));
            late.step(match, of_late);
        }
    }
    match.expect_it_happened();
    EXPECT_GT(match.server.counts().filled, 5U);
    EXPECT_EQ(compared, match.server.confirmed());
    EXPECT_GT(of_late, 250U);
    for (const Watcher* watcher : {&first, &late}) {
        EXPECT_GE(watcher->session.counts().hashes, 2U);
        EXPECT_EQ(watcher->session.counts().out_of_sync, 0U);
        EXPECT_FALSE(watcher->session.needs_state());
    }
}

// A client's confirmed inputs are the server's: its recording plays the same match.
TEST(Spectators, ClientsConfirmTheSameInputs) {
    MatchPlay match({.delay_s = 0.1, .jitter_s = 0.06, .loss = 0.1, .duplication = 0.1}, 22);
    Watcher watcher;
    const ClientSession& client = match.machines[2]->session;
    std::uint64_t compared = 0;
    for (int round = 0; round < 80; ++round) {
        match.play(0.05);
        (void)watcher.session.receive(packet_after(client, watcher.sent_until, watcher.sent_until));
        watcher.step(match, compared);
    }
    EXPECT_GT(compared, 300U);
    EXPECT_EQ(watcher.session.now(), client.final_state());
    EXPECT_GE(watcher.session.counts().hashes, 3U);
    EXPECT_EQ(watcher.session.counts().out_of_sync, 0U);
}

TEST(Spectators, LostLateAndDoubledPacketsChangeNothing) {
    MatchPlay match({.delay_s = 0.02}, 23);
    test::Random random(5);
    Watcher watcher;
    std::deque<Packet> old;
    std::uint64_t compared = 0;
    for (int round = 0; round < 100; ++round) {
        match.play(0.03);
        // The host says what has come; a third of its packets is lost.
        MatchTick until = 0;
        Packet packet = packet_after(match.server, watcher.session.received(), until);
        if (random.between(0.0, 1.0) < 0.67) {
            (void)watcher.session.receive(packet);
        }
        old.push_back(std::move(packet));
        const auto any = static_cast<std::size_t>(random.between(0.0, 1.0) *
                                                  static_cast<double>(old.size() - 1));
        (void)watcher.session.receive(old[any]);
        watcher.step(match, compared);
    }
    EXPECT_GT(compared, 200U);
    EXPECT_FALSE(watcher.session.needs_state());
}

TEST(Spectators, CutAndFlippedPacketsAreRefusedAndChangeNothing) {
    MatchPlay match({.delay_s = 0.02}, 24);
    match.play(1.2);
    MatchTick until = 0;
    const Packet packet = packet_after(match.server, 0, until);
    Watcher watcher;
    for (std::size_t size = 0; size < packet.size(); ++size) {
        ASSERT_NE(watcher.session.receive(std::span(packet).first(size)), MatchRefusal::none);
    }
    for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
        Packet flipped = packet;
        flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
        ASSERT_NE(watcher.session.receive(flipped), MatchRefusal::none) << bit;
    }
    EXPECT_EQ(watcher.session.received(), 0U);
    EXPECT_EQ(watcher.session.receive(packet), MatchRefusal::none);
    EXPECT_EQ(watcher.session.received(), until);
}

TEST(Spectators, AWorldThatDiffersIsFound) {
    MatchPlay match({.delay_s = 0.02}, 25);
    Watcher watcher;
    World& world = watcher.scene.world;
    const Entity rock = find_by_id(world, persistent_id_from_name("rock1"));
    world.body_pose.at(rock).pose_ws.position.x() += 1e-9;
    for (int round = 0; round < 30; ++round) {
        match.play(0.05);
        (void)watcher.session.receive(
            packet_after(match.server, watcher.sent_until, watcher.sent_until));
        while (watcher.session.advance(false)) {
        }
    }
    EXPECT_EQ(watcher.session.counts().out_of_sync, watcher.session.counts().hashes);
    EXPECT_TRUE(watcher.session.needs_state());
}

TEST(Spectators, WhoFallsBehindForTooLongNeedsAState) {
    MatchPlay match({.delay_s = 0.02}, 26);
    match.play(5.6);
    EXPECT_FALSE(match.server.can_write_after(0));
    EXPECT_FALSE(match.server.can_write_after(match.server.confirmed() + 1));
    EXPECT_TRUE(match.server.can_write_after(match.server.confirmed()));
}

TEST(Spectators, StayAFewTicksBehindWhatHasCome) {
    MatchPlay match({.delay_s = 0.02}, 27);
    Watcher watcher;
    for (int frame = 0; frame < 500; ++frame) {
        match.play(k_tick_s);
        if (frame % 3 == 0) {
            (void)watcher.session.receive(
                packet_after(match.server, watcher.sent_until, watcher.sent_until));
        }
        const int due = watcher.session.ticks_due(k_tick_s);
        EXPECT_LE(due, 2) << frame;
        for (int i = 0; i < due; ++i) {
            (void)watcher.session.advance(false);
        }
        if (frame > 250) {
            const auto waiting =
                static_cast<double>(watcher.session.received() - watcher.session.now());
            EXPECT_NEAR(waiting, SpectatorSession::k_behind_ticks, 4.0) << frame;
        }
    }
}

// The arrays of a world may still grow when a scene becomes fuller than ever.
TEST(Spectators, PacketsAllocateNothingOnceWarmAndStepsNextToNothing) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer has its own operators";
    }
    MatchPlay match({.delay_s = 0.02}, 28);
    Watcher watcher;
    std::array<std::byte, k_most_confirmed_bytes> packet{};
    std::uint64_t of_packets = 0;
    std::uint64_t of_steps = 0;
    for (int round = 0; round < 60; ++round) {
        match.play(0.05);
        const std::uint64_t before = allocation_count();
        const std::size_t size =
            match.server.write_watched(watcher.sent_until, watcher.sent_until, packet);
        (void)watcher.session.receive(std::span(packet).first(size));
        const std::uint64_t between = allocation_count();
        while (watcher.session.advance(false)) {
        }
        constexpr int k_warm_rounds = 20;
        of_packets += round > 0 ? between - before : 0;
        of_steps += round > k_warm_rounds ? allocation_count() - between : 0;
    }
    EXPECT_EQ(of_packets, 0U);
    EXPECT_LE(of_steps, 2U);
}

}  // namespace
}  // namespace handhold::match_test
