// Matches over QUIC.
#include <gtest/gtest.h>

#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/quic_test.hpp"
#include "tests/game/net/udp_proxy.hpp"

namespace handhold::quic_match_test {
namespace {

using test::add_peer;
using test::LoopbackMatch;
using test::LoopbackPeer;

class QuicMatchTest : public test::QuicTest {};

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
        EXPECT_GT(peer->compared, 60U);
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

// The match's clock runs at twice the wall's, so a tick is shorter than it seems to QUIC.
TEST_F(QuicMatchTest, MatchGoesOnWhereOneDatagramInTwentyIsLost) {
    LoopbackMatch match(3);
    test::UdpProxy proxy(match.listener().port());
    proxy.loss = 0.05;
    LoopbackPeer& lossy = add_peer(match, 1, proxy.url(match.quic_url()));
    add_peer(match, 2, match.quic_url());
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(30.0, [&] { return match.all_play(); }));
    const std::uint64_t before = proxy.passed_up + proxy.passed_down + proxy.lost;
    const std::uint64_t sent = match.listener().counts().sent_messages;
    match.run(8.0);
    EXPECT_EQ(lossy.different, 0U);
    EXPECT_EQ(lossy.peer->states(), 1U);
    EXPECT_GT(lossy.compared, 60U);
    EXPECT_GT(lossy.peer->match().stats().rollbacks, 30U);
    EXPECT_GT(match.grips, 5U);
    EXPECT_GT(proxy.lost, 20U);
    EXPECT_EQ(match.server->match().stats().out_of_sync, 0U);
    RecordProperty("datagrams",
                   static_cast<int>(proxy.passed_up + proxy.passed_down + proxy.lost - before));
    RecordProperty("lost", static_cast<int>(proxy.lost));
    RecordProperty("messages_sent",
                   static_cast<int>(match.listener().counts().sent_messages - sent));
    RecordProperty("messages_dropped", static_cast<int>(match.listener().counts().dropped));
}

// Something always waits to be sent there, and the stream itself is at rest.
TEST_F(QuicMatchTest, PlayerOnANarrowNetworkIsNotTakenForOneWhoDoesNotRead) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(2, {}, [](ListenerSettings& settings) { settings.slow_after_s = 1.0; });
    test::UdpProxy proxy(match.listener().port());
    LoopbackPeer& peer = add_peer(match, 1, proxy.url(match.quic_url()));
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    proxy.down_bytes_per_s = 400.0;
    match.run(10.0);
    EXPECT_EQ(match.listener().counts().ended_slow, 0U);
    EXPECT_GT(match.listener().counts().dropped, 0U);
    EXPECT_TRUE(peer.plays());
    RecordProperty("messages_dropped", static_cast<int>(match.listener().counts().dropped));
}

TEST_F(QuicMatchTest, PlayerWhoseAddressChangesPlaysOn) {
    LoopbackMatch match(3);
    test::UdpProxy proxy(match.listener().port());
    LoopbackPeer& moves = add_peer(match, 1, proxy.url(match.quic_url()));
    add_peer(match, 2, match.quic_url());
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    match.run(1.0);
    for (int i = 0; i < 3; ++i) {
        proxy.rebind();
        const std::uint64_t down = proxy.passed_down;
        const std::uint64_t compared = moves.compared;
        match.run(2.0);
        EXPECT_GT(proxy.passed_down, down + 50) << "the server follows";
        EXPECT_GT(moves.compared, compared + 50);
    }
    EXPECT_TRUE(moves.plays());
    EXPECT_EQ(moves.different, 0U);
    EXPECT_EQ(moves.peer->states(), 1U);
    EXPECT_EQ(match.listener().counts().opened, 2U);
    EXPECT_EQ(match.server->counts().joins, 2U);
}

// Why there is no connection, as the player reads it.
std::string why_not(LoopbackMatch& match, const std::string& url) {
    LoopbackPeer& peer = add_peer(match, 9, url);
    EXPECT_TRUE(match.run_until(30.0, [&] { return peer.peer->stage() == PeerStage::ended; }));
    return peer.peer->why();
}

TEST_F(QuicMatchTest, ServersWithoutATrustedCertificateAreRefusedInOneLine) {
    LoopbackMatch match(2);
    const std::string url = match.quic_url();
    const std::string without = url.substr(0, url.find('#'));
    EXPECT_EQ(why_not(match, without),
              "no server: the server's certificate is not known here: join by the whole address "
              "that the server prints, quic://HOST:PORT#FINGERPRINT");
    std::string other = url;
    other.back() = other.back() == '0' ? '1' : '0';
    EXPECT_EQ(why_not(match, other), "no server: the server's certificate has another fingerprint");
    EXPECT_EQ(match.server->counts().joins, 0U);
    std::string colons = without + "#";
    for (std::size_t i = without.size() + 1; i < url.size(); i += 2) {
        colons += (i > without.size() + 1 ? ":" : "") + url.substr(i, 2);
    }
    match.peers.clear();
    add_peer(match, 1, colons);
    EXPECT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
}

TEST_F(QuicMatchTest, AddressesThatAreNoneAreRefused) {
    for (const char* const url :
         {"quic://:1", "quic://127.0.0.1", "quic://127.0.0.1:0", "quic://127.0.0.1:65536",
          "quic://127.0.0.1:1#", "quic://127.0.0.1:1#00ff", "quic://127.0.0.1:1/x"}) {
        const auto link = open_link(url);
        ASSERT_FALSE(link.ok()) << url;
        EXPECT_NE(link.error().message().find("expected quic://HOST:PORT"), std::string::npos);
    }
    const auto offer = fetch_offer("quic://127.0.0.1:1", 2.0);
    ASSERT_FALSE(offer.ok());
    EXPECT_NE(offer.error().message().find("no server: connection refused"), std::string::npos)
        << offer.error().message();
}

TEST_F(QuicMatchTest, NoMoreConnectionsThanTheLimitAreOpened) {
    LoopbackMatch match(4, {}, [](ListenerSettings& settings) { settings.most_links = 2; });
    add_peer(match, 1, match.quic_url());
    add_peer(match, 2, match.quic_url());
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    EXPECT_EQ(why_not(match, match.quic_url()), "no server: the server takes no more connections");
    EXPECT_EQ(match.listener().counts().refused, 1U);
    match.peers[0]->peer->leave();
    ASSERT_TRUE(match.run_until(10.0, [&] { return match.server->seats().taken() == 1; }));
    match.peers.pop_back();
    add_peer(match, 3, match.quic_url());
    EXPECT_TRUE(match.run_until(20.0, [&] { return match.peers.back()->plays(); }));
}

}  // namespace
}  // namespace handhold::quic_match_test
