// A level whose state is large: whoever joins gets it before the inputs after it are forgotten.
#include <gtest/gtest.h>

#include "game/net/pack_state.hpp"
#include "tests/game/net/loopback_match.hpp"

namespace handhold::large_state_test {
namespace {

// Shelves far from everybody.
MatchScene crowded_match(std::size_t players) {
    Scene scene = test::tunnel_with_loose_boxes();
    hh_body_def box = hh::body_def();
    box.shape = *scene.host.add_box({0.1, 0.1, 0.1});
    for (int i = 0; i < 12000; ++i) {
        box.pose.position = {100.0 + i % 30, 0.5 * (i / 30 % 30), 0.5 * (i / 900)};
        (void)scene.host.add(box);
    }
    return std::move(make_match_scene(std::move(scene), players, 7).value());
}

TEST(LargeState, OfMoreThanTwoAndAHalfMegabytesIsJoined) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    HH_NEEDS_REAL_TIME();
    for (const bool is_quic : {false, true}) {
        test::LoopbackMatch match(
            2, [](MatchServerSettings& settings) { settings.tick_s = 1.0 / 90.0; }, {},
            crowded_match);
        test::LoopbackPeer peer(2, 1, {}, crowded_match);
        peer.settings.unpacks = false;
        const std::string url = is_quic ? match.quic_url() : match.url();
        peer.connect(std::move(open_link(url).value()));
        match.others = [&peer] { peer.poll(); };
        EXPECT_TRUE(match.run_until(30.0, [&] { return peer.plays(); })) << peer.peer->why();
        EXPECT_GT(match.server->counts().state_bytes_packed, 2'500'000U);
        EXPECT_TRUE(
            match.run_until(15.0, [&] { return match.server->match().stats().hashes > 0; }));
        EXPECT_TRUE(peer.plays());
        EXPECT_EQ(peer.peer->states(), 1U);
        EXPECT_EQ(match.server->match().stats().out_of_sync, 0U);
        RecordProperty(is_quic ? "quic_datagrams" : "state_bytes",
                       static_cast<int>(is_quic ? match.listener().counts().sent_datagrams
                                                : match.server->counts().state_bytes));
    }
}

// No poll packs more than its tick's share. The clock is the test's, so the machine's speed is
// irrelevant; it stands still until the hello has come.
TEST(LargeState, IsPackedInParts) {
    if (!has_network() || !has_packing()) {
        GTEST_SKIP() << "built without a network, or without zstd";
    }
    constexpr double k_tick_s = 1.0 / 90.0;
    double now_s = 0.0;
    double packed_bytes_per_s = 0.0;
    test::LoopbackMatch match(
        2,
        [&](MatchServerSettings& settings) {
            settings.clock = [&now_s] { return now_s; };
            packed_bytes_per_s = settings.packed_bytes_per_s;
        },
        {}, crowded_match);
    test::LoopbackPeer peer(2, 1, {}, crowded_match);
    peer.settings.clock = [&now_s] { return now_s; };
    peer.connect(match.link());
    const MatchServerCounts& counts = match.server->counts();
    for (int i = 0; i < 10'000 && counts.states == 0; ++i) {
        match.server->poll();
        peer.poll();
    }
    ASSERT_EQ(counts.states, 1U);
    ASSERT_GT(counts.state_bytes, 2'500'000U);
    int polls = 0;
    while (counts.state_bytes_packed == 0 && polls < 1000) {
        now_s += k_tick_s;
        match.server->poll();
        ++polls;
    }
    const double shares = static_cast<double>(counts.state_bytes) / (packed_bytes_per_s * k_tick_s);
    EXPECT_GE(polls, shares);
    EXPECT_LE(polls, shares + 2.0);
}

}  // namespace
}  // namespace handhold::large_state_test
