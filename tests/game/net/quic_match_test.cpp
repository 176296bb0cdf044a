// Matches over QUIC.
#include <gtest/gtest.h>

#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"

namespace handhold::quic_match_test {
namespace {

using test::LoopbackMatch;
using test::LoopbackPeer;

class QuicMatchTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_quic()) {
            GTEST_SKIP() << "built without ngtcp2";
        }
    }
};

LoopbackPeer& add_peer(LoopbackMatch& match, std::uint64_t number, const std::string& url) {
    match.peers.push_back(std::make_unique<LoopbackPeer>(match.scene().players.size(), number));
    match.peers.back()->connect(std::move(open_link(url).value()));
    return *match.peers.back();
}

TEST_F(QuicMatchTest, PeersOfBothTransportsAreEqualBitForBit) {
    LoopbackMatch match(4);
    add_peer(match, 1, match.quic_url());
    add_peer(match, 2, match.quic_url());
    add_peer(match, 3, match.url());
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    match.run(8.0);
    for (const auto& peer : match.peers) {
        const hh_match_stats stats = peer->peer->match().stats();
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 200U);
        EXPECT_GT(stats.rollbacks, 30U);
        EXPECT_EQ(peer->peer->states(), 1U);
    }
    const hh_match_stats stats = match.server->match().stats();
    EXPECT_GT(match.grips, 10U);
    EXPECT_GT(stats.hashes, 15U);
    EXPECT_EQ(stats.out_of_sync, 0U);
    EXPECT_EQ(match.server->counts().bad_packets, 0U);
    const ListenerCounts& traffic = match.listener().counts();
    EXPECT_GT(traffic.received_datagrams, 300U);
    EXPECT_EQ(traffic.stray_datagrams, 0U);
    RecordProperty("received_datagrams", static_cast<int>(traffic.received_datagrams));
    RecordProperty("sent_datagrams", static_cast<int>(traffic.sent_datagrams));
}

}  // namespace
}  // namespace handhold::quic_match_test
