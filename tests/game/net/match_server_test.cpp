// Matches over real sockets: joining, playing, leaving, returning, being refused, draining.
#include "game/net/match_server.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"

namespace handhold::match_server_test {
namespace {

using test::LoopbackMatch;
using test::LoopbackPeer;

class MatchServerTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_network()) {
            GTEST_SKIP() << "built without a network";
        }
    }
};

TokenKey test_key() { return {std::vector<std::byte>(32, std::byte{7})}; }

TEST_F(MatchServerTest, ServerAndThreePeersAreEqualBitForBitForTenSeconds) {
    LoopbackMatch match(4);
    for (const std::uint64_t number : {1U, 2U, 3U}) {
        match.add_peer(number);
    }
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    match.run(10.0);
    for (const auto& peer : match.peers) {
        const hh_match_stats stats = peer->peer->match().stats();
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 300U);
        EXPECT_GT(stats.rollbacks, 30U);
        EXPECT_EQ(peer->peer->states(), 1U);
    }
    const hh_match_stats stats = match.server->match().stats();
    EXPECT_GT(match.grips, 10U);
    EXPECT_GT(stats.hashes, 20U);
    EXPECT_EQ(stats.out_of_sync, 0U);
    EXPECT_EQ(match.server->counts().bad_packets, 0U);
    EXPECT_EQ(match.server->counts().bad_messages, 0U);
    EXPECT_EQ(match.server->seats().taken(), 3U);
    RecordProperty("compared", static_cast<int>(match.peers[0]->compared));
    RecordProperty("filled", static_cast<int>(stats.filled));
    RecordProperty("ticks", static_cast<int>(stats.ticks));
}

TEST_F(MatchServerTest, PlayerWhoLostTheConnectionComesBackToTheirSlot) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(3);
    match.add_peer(1);
    LoopbackPeer& lost = match.add_peer(2);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    const std::size_t slot = lost.peer->slot();
    match.run(1.0);
    lost.connect(match.link());  // the old connection is cut
    ASSERT_TRUE(match.run_until(10.0, [&] { return match.all_play(); }));
    match.run(1.0);
    EXPECT_EQ(lost.peer->slot(), slot);
    EXPECT_EQ(lost.peer->states(), 2U);
    EXPECT_EQ(match.server->counts().returns, 1U);
    // Somebody else gets the third slot, not the one that waits.
    lost.connect(match.link());
    LoopbackPeer& third = match.add_peer(3);
    ASSERT_TRUE(match.run_until(10.0, [&] { return match.all_play(); }));
    EXPECT_NE(third.peer->slot(), slot);
    match.run(1.0);
    for (const auto& peer : match.peers) {
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 30U);
    }
}

// Why a peer is not admitted, as its player reads it.
std::string refusal_of(LoopbackMatch& match, LoopbackPeer& peer) {
    EXPECT_TRUE(match.run_until(10.0, [&] { return peer.peer->stage() == PeerStage::ended; }));
    return peer.peer->why();
}

TEST_F(MatchServerTest, FullMatchSaysSo) {
    LoopbackMatch match(1);
    match.add_peer(1);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    EXPECT_EQ(refusal_of(match, match.add_peer(2)), "the match is full");
    EXPECT_TRUE(match.peers[0]->plays());
}

TEST_F(MatchServerTest, DigestThatDiffersIsNamed) {
    LoopbackMatch match(2);
    for (std::size_t digest = 0; digest < k_match_digests; ++digest) {
        auto other = std::make_unique<LoopbackPeer>(2, 1);
        other->settings.digests[digest] ^= 1U;
        other->connect(match.link());
        match.peers.push_back(std::move(other));
        EXPECT_EQ(refusal_of(match, *match.peers.back()),
                  "other level: \"" + std::string(digest_name(digest)) + "\" differs");
    }
    EXPECT_EQ(match.server->counts().refused[static_cast<std::size_t>(NetRefusal::level)],
              k_match_digests);
}

TEST_F(MatchServerTest, OtherTuningOrBodiesHaveOtherDigests) {
    const MatchDigests own = test::tunnel_match(2).digests;
    EXPECT_EQ(first_difference(own, test::tunnel_match(2).digests), std::nullopt);
    const auto differs = [&](Scene scene, MatchDigest which) {
        const auto made = make_match_scene(std::move(scene), 2, 7);
        const auto found = first_difference(own, made.value().digests);
        return found == static_cast<std::size_t>(which);
    };
    Scene tuned = test::tunnel_with_loose_boxes();
    EXPECT_TRUE(tuned.host.tune("locomotion.thruster_mps2", 0.25));
    EXPECT_TRUE(differs(std::move(tuned), MatchDigest::tuning));
    Scene moved = test::tunnel_with_loose_boxes();
    hh_body_def box = hh::body_def();
    box.shape = *moved.host.add_box({0.1, 0.1, 0.1});
    box.pose.position = {0.5, 0.6, 2.0};
    (void)moved.host.add(box);
    EXPECT_TRUE(differs(std::move(moved), MatchDigest::bodies));
}

TEST_F(MatchServerTest, TokensAdmitOneSlotEachUntilTheyExpire) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(3, [](MatchServerSettings& settings) { settings.key = test_key(); });
    EXPECT_EQ(refusal_of(match, match.add_peer(1)), "the server wants a token (--token)");
    EXPECT_EQ(refusal_of(match, match.add_peer(2, issue_token(test_key(), "ann", 1000))),
              "the token has expired");
    const TokenKey other{std::vector<std::byte>(32, std::byte{8})};
    EXPECT_EQ(refusal_of(match, match.add_peer(3, issue_token(other, "ann", 2000))),
              "the token is not one of this server");
    match.peers.clear();
    const std::string good = issue_token(test_key(), "ann", 2000);
    LoopbackPeer& first = match.add_peer(4, good);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    // The same person from elsewhere takes over the slot.
    LoopbackPeer& second = match.add_peer(5, good);
    EXPECT_EQ(refusal_of(match, first), "the same person has joined from elsewhere");
    ASSERT_TRUE(match.run_until(20.0, [&] { return second.plays(); }));
    EXPECT_EQ(second.peer->slot(), first.peer->slot());
    EXPECT_EQ(match.server->seats().taken(), 1U);
}

// A connection whose messages the test writes.
struct RawPeer final : LinkHandler {
    explicit RawPeer(std::unique_ptr<Link> to) : link(std::move(to)) {}
    void opened() override {}
    void received(std::span<const std::byte> message) override {
        if (const auto found = read_refused(message)) {
            refused = found;
        }
    }
    void closed(std::string_view /*why*/) override { is_closed = true; }

    std::unique_ptr<Link> link;
    std::optional<MatchRefused> refused;
    bool is_closed = false;
};

TEST_F(MatchServerTest, OtherVersionIsToldBoth) {
    LoopbackMatch match(2);
    RawPeer raw(match.link());
    match.others = [&] { raw.link->poll(0.0, raw); };
    std::vector<std::byte> hello;
    write_message(MatchHello{.version = k_net_version + 1, .digests = {}, .token = {}}, hello);
    raw.link->send(Delivery::reliable, hello);
    ASSERT_TRUE(match.run_until(10.0, [&] { return raw.is_closed; }));
    ASSERT_TRUE(raw.refused.has_value());
    EXPECT_EQ(raw.refused->reason, NetRefusal::version);
    EXPECT_EQ(raw.refused->detail, k_net_version);
    EXPECT_EQ(refusal_text({NetRefusal::version, k_net_version + 1}),
              "other version: the server speaks " + std::to_string(k_net_version + 1) +
                  ", this program " + std::to_string(k_net_version));
}

TEST_F(MatchServerTest, WhereNobodyListensThereIsNoServer) {
    LoopbackMatch match(1);
    const std::string url = match.url();
    match.server.reset();
    if (!has_websocket()) {
        GTEST_SKIP() << "built without libwebsockets";
    }
    const auto offer = fetch_offer("ws://127.0.0.1:1", 2.0);
    ASSERT_FALSE(offer.ok());
    EXPECT_NE(offer.error().message().find("no server"), std::string::npos)
        << offer.error().message();
    EXPECT_FALSE(open_link("http://127.0.0.1:1").ok());
    EXPECT_FALSE(open_link("ws://:1").ok());
    EXPECT_FALSE(open_link("ws://127.0.0.1:99999").ok());
}

TEST_F(MatchServerTest, ServerThatFallsSilentIsLeftAndPlayerMayReturn) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(2);
    auto made = std::make_unique<LoopbackPeer>(2, 1);
    made->settings.silent_after_s = 0.5;
    made->connect(match.link());
    LoopbackPeer& peer = *made;
    match.peers.push_back(std::move(made));
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    const double begin_s = test::match_clock_s();
    while (peer.plays() && test::match_clock_s() - begin_s < 5.0) {
        peer.poll();  // and the server does nothing
    }
    EXPECT_EQ(peer.peer->stage(), PeerStage::ended);
    EXPECT_TRUE(peer.peer->may_return());
    EXPECT_GE(test::match_clock_s() - begin_s, 0.4);  // heard just before
    peer.connect(match.link());
    EXPECT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    EXPECT_EQ(match.server->counts().returns, 1U);
    match.run(1.0);
    EXPECT_EQ(peer.different, 0U);
}

TEST_F(MatchServerTest, DrainTellsEverybodyAndAdmitsNobody) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(3);
    LoopbackPeer& first = match.add_peer(1);
    match.add_peer(2);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    EXPECT_EQ(match.server->get("/health").status, 200);
    match.server->drain();
    EXPECT_EQ(match.server->get("/health").status, 503);
    LoopbackPeer& late = match.add_peer(3);
    ASSERT_TRUE(match.run_until(10.0, [&] {
        return match.server->is_drained() && late.peer->stage() == PeerStage::ended;
    }));
    EXPECT_EQ(first.peer->why(), "the server is shutting down");
    EXPECT_EQ(first.peer->bye(), NetBye::draining);
    EXPECT_EQ(late.peer->why(), "the server is shutting down");
    EXPECT_EQ(match.server->seats().taken(), 0U);
}

}  // namespace
}  // namespace handhold::match_server_test
