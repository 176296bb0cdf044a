// Datagrams in a peer's name from another address, by a listener on the way.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/quic_test.hpp"
#include "tests/game/net/udp_proxy.hpp"

namespace handhold::forged_datagram_test {
namespace {

using test::add_peer;
using test::expect_unharmed;
using test::LoopbackMatch;
using test::LoopbackPeer;
using test::RawUdp;
using test::UdpProxy;

class ForgedDatagramTest : public test::QuicTest {};

// What a listener on the way may do: it sees all datagrams, and sends what it likes besides.
enum class Mischief : std::uint8_t { truncated, flipped, replayed, noise };

struct MischiefCase {
    Mischief kind;
    int copies;  // of each datagram
};

class MischiefTest : public testing::TestWithParam<MischiefCase> {
  protected:
    void SetUp() override {
        if (!has_quic()) {
            GTEST_SKIP() << "built without ngtcp2";
        }
    }
};

TEST_P(MischiefTest, DatagramsFromAnotherAddressChangeNothing) {
    LoopbackMatch match(3);
    UdpProxy proxy(match.listener().port());
    RawUdp mallory;
    test::Random random(7);
    std::vector<std::vector<std::uint8_t>> kept;
    std::uint64_t sent = 0;
    proxy.seen_up = [&](const std::vector<std::uint8_t>& bytes) {
        std::vector<std::uint8_t> forged = bytes;
        const double draw = random.between(0.0, 1.0);
        const auto at = static_cast<std::size_t>(
            draw * static_cast<double>(std::max<std::size_t>(forged.size(), 1)));
        switch (GetParam().kind) {
            case Mischief::truncated:
                forged.resize(at);
                break;
            case Mischief::flipped:
                forged[at] ^= 4U;
                break;
            case Mischief::replayed:
                kept.push_back(forged);
                forged = kept[static_cast<std::size_t>(draw * static_cast<double>(kept.size()))];
                break;
            case Mischief::noise:
                std::ranges::generate(forged, [&random] {
                    return static_cast<std::uint8_t>(random.between(0.0, 256.0));
                });
                break;
        }
        for (int i = 0; i < GetParam().copies; ++i) {
            mallory.send(match.listener().port(), forged);
            ++sent;
        }
    };
    LoopbackPeer& seen = add_peer(match, 1, proxy.url(match.quic_url()));
    LoopbackPeer& other = add_peer(match, 2, match.quic_url());
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    const std::uint64_t down = proxy.passed_down;
    match.run(1.0);
    // So many were sent, and the server still answers its peer.
    EXPECT_TRUE(
        match.run_until(60.0, [&] { return sent > 200 && proxy.passed_down > down + 100; }));
    expect_unharmed(match, seen);
    expect_unharmed(match, other);
    EXPECT_EQ(match.server->counts().bad_packets, 0U);
    EXPECT_EQ(match.server->counts().joins, 2U);
    EXPECT_EQ(match.listener().counts().opened, 2U);
    EXPECT_EQ(match.listener().counts().throttled, 0U);
    EXPECT_EQ(match.listener().counts().unread_datagrams, 0U);
    RecordProperty("forged", static_cast<int>(sent));
    RecordProperty("stray", static_cast<int>(match.listener().counts().stray_datagrams));
    RecordProperty("longest_poll_us", static_cast<int>(1e6 * match.longest_poll_s));
}

// What the attacker sends beyond what is read costs only the attacker.
TEST_F(ForgedDatagramTest, AFloodInAPeersNameFromAnotherAddressLosesNoneOfThePeers) {
    // A small burst: one round's copies are more than it. The peers stay below theirs.
    LoopbackMatch match(3, {}, [](ListenerSettings& settings) {
        settings.budget = {.messages_per_s = 4000.0, .bytes_per_s = 300e3, .burst_s = 0.04};
    });
    UdpProxy proxy(match.listener().port());
    RawUdp mallory;
    std::vector<std::uint8_t> forged;
    proxy.seen_up = [&forged](const std::vector<std::uint8_t>& bytes) {
        forged = bytes;
        forged.resize(1200);
    };
    LoopbackPeer& seen = add_peer(match, 1, proxy.url(match.quic_url()));
    LoopbackPeer& other = add_peer(match, 2, match.quic_url());
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    seen.compared = 0;
    other.compared = 0;
    match.others = [&] {
        proxy.poll();
        for (int i = 0; i < 120; ++i) {
            mallory.send(match.listener().port(), forged);
        }
    };
    EXPECT_TRUE(match.run_until(
        30.0, [&match] { return match.listener().counts().unread_elsewhere > 300; }));
    expect_unharmed(match, seen);
    expect_unharmed(match, other);
    const ListenerCounts& counts = match.listener().counts();
    EXPECT_EQ(counts.unread_datagrams, 0U);
    EXPECT_EQ(counts.throttled, 0U);
    RecordProperty("unread", static_cast<int>(counts.unread_elsewhere));
    RecordProperty("overflowed", static_cast<int>(counts.overflowed_datagrams));
}

// Until the peer's next packet comes first, the server answers whoever sent a copy before it. What
// else comes from there is not charged to the peer.
TEST_F(ForgedDatagramTest, AFloodFromWhereCopiesComeFirstLosesNoneOfThePeers) {
    LoopbackMatch match(2, {}, [](ListenerSettings& settings) {
        settings.budget = {.messages_per_s = 4000.0, .bytes_per_s = 300e3, .burst_s = 0.04};
    });
    UdpProxy proxy(match.listener().port());
    RawUdp mallory;
    LoopbackPeer& seen = add_peer(match, 1, proxy.url(match.quic_url()));
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    int rounds = 0;
    std::vector<std::uint8_t> forged;
    proxy.seen_before = [&](const std::vector<std::uint8_t>& bytes) {
        forged = bytes;
        if (rounds % 8 < 4) {
            mallory.send(match.listener().port(), bytes);
        }
    };
    std::uint64_t diverted = 0;
    match.others = [&] {
        proxy.poll();
        forged.resize(1200);
        // Bursts with pauses, so that copies are read in between.
        for (int i = 0; i < (rounds % 8 == 5 ? 240 : 0); ++i) {
            mallory.send(match.listener().port(), forged);
        }
        ++rounds;
        std::vector<std::uint8_t> bytes;
        for (int from = 0; mallory.receive(bytes, from);) {
            ++diverted;
        }
    };
    EXPECT_TRUE(match.run_until(
        60.0, [&] { return diverted > 20 && match.listener().counts().unread_elsewhere > 300; }));
    EXPECT_TRUE(seen.plays());
    EXPECT_EQ(seen.different, 0U);
    EXPECT_EQ(match.listener().counts().unread_datagrams, 0U);
    EXPECT_EQ(match.listener().counts().throttled, 0U);
    RecordProperty("diverted", static_cast<int>(diverted));
}

// 40 copies are five times what the peer itself may send.
INSTANTIATE_TEST_SUITE_P(
    Kinds, MischiefTest,
    testing::Values(MischiefCase{Mischief::truncated, 3}, MischiefCase{Mischief::flipped, 3},
                    MischiefCase{Mischief::flipped, 40}, MischiefCase{Mischief::replayed, 3},
                    MischiefCase{Mischief::replayed, 40}, MischiefCase{Mischief::noise, 3}));

}  // namespace
}  // namespace handhold::forged_datagram_test
