// Peers that send what they should not, or read nothing: what it costs the others.
#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "game/net/send_queue.hpp"
#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/raw_socket.hpp"
#include "tests/random.hpp"

namespace handhold::hostile_peer_test {
namespace {

using test::LoopbackMatch;
using test::RawSocket;

enum class Hostility : std::uint8_t { truncated, flipped, replayed, flooding, garbage };

// A link whose packets are changed on their way.
class HostileLink final : public Link {
  public:
    HostileLink(std::unique_ptr<Link> to, Hostility how) : link_(std::move(to)), how_(how) {}

    void poll(double wait_s, LinkHandler& handler) override { link_->poll(wait_s, handler); }
    std::size_t queued_bytes() const override { return link_->queued_bytes(); }
    void close() override { link_->close(); }
    void send(Delivery delivery, std::span<const std::byte> message) override {
        if (kind_of(message) != NetKind::packet) {
            link_->send(delivery, message);
            return;
        }
        ++packets;
        std::vector<std::byte> bytes(message.begin(), message.end());
        const double draw = random_.between(0.0, 1.0);
        switch (how_) {
            case Hostility::truncated:
                bytes.resize(
                    1 + static_cast<std::size_t>(draw * static_cast<double>(bytes.size() - 1)));
                break;
            case Hostility::flipped:
                bytes[1 + static_cast<std::size_t>(draw * static_cast<double>(bytes.size() - 1))] ^=
                    std::byte{16};
                break;
            case Hostility::replayed:
                kept_.push_back(bytes);
                bytes = kept_[static_cast<std::size_t>(draw * static_cast<double>(kept_.size()))];
                link_->send(Delivery::newest, message);
                break;
            case Hostility::flooding:
                for (int i = 0; i < 60; ++i) {
                    link_->send(Delivery::reliable, bytes);
                }
                break;
            case Hostility::garbage:
                for (std::byte& byte : bytes) {
                    byte = static_cast<std::byte>(random_.between(0.0, 256.0));
                }
                bytes[0] = static_cast<std::byte>(NetKind::packet);
                break;
        }
        link_->send(delivery, bytes);
    }

    std::uint64_t packets = 0;

  private:
    std::unique_ptr<Link> link_;
    Hostility how_;
    test::Random random_{11};
    std::vector<std::vector<std::byte>> kept_;
};

class HostilePeerTest : public testing::TestWithParam<Hostility> {
  protected:
    void SetUp() override {
        if (!has_websocket()) {
            GTEST_SKIP() << "built without libwebsockets";
        }
    }
};

TEST_P(HostilePeerTest, OthersPlayOnUnharmed) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(3, [](MatchServerSettings& settings) { settings.silent_after_s = 0.8; });
    match.add_peer(1);
    match.add_peer(2);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    auto hostile = std::make_unique<test::LoopbackPeer>(3, 3);
    hostile->connect(std::make_unique<HostileLink>(match.link(), GetParam()));
    match.peers.push_back(std::move(hostile));
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.peers[2]->plays(); }));
    const std::uint64_t bad = match.server->counts().bad_packets;
    match.run(1.4);
    for (std::size_t i = 0; i < 2; ++i) {
        const test::LoopbackPeer& other = *match.peers[i];
        EXPECT_TRUE(other.plays());
        EXPECT_EQ(other.different, 0U);
        EXPECT_GT(other.compared, 40U);
        EXPECT_EQ(other.peer->states(), 1U) << "another needed a new state";
    }
    const MatchServerCounts& counts = match.server->counts();
    const ListenerCounts& traffic = match.listener().counts();
    EXPECT_LE(traffic.most_queued_bytes, SendQueue::k_most_bytes);
    if (GetParam() == Hostility::flooding) {
        EXPECT_GE(traffic.throttled, 1U);
    } else if (GetParam() != Hostility::replayed) {
        EXPECT_GT(counts.bad_packets, bad + 30);
        EXPECT_EQ(counts.silent, 1U);
    } else {
        EXPECT_EQ(match.peers[2]->different, 0U);
        EXPECT_TRUE(match.peers[2]->plays());
    }
    RecordProperty("bad_packets", static_cast<int>(counts.bad_packets));
    RecordProperty("throttled", static_cast<int>(traffic.throttled));
    RecordProperty("received", static_cast<int>(traffic.received_messages));
    RecordProperty("longest_poll_us", static_cast<int>(1e6 * match.longest_poll_s));
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostilePeerTest,
                         testing::Values(Hostility::truncated, Hostility::flipped,
                                         Hostility::replayed, Hostility::flooding,
                                         Hostility::garbage));

class HostileConnectionTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_websocket()) {
            GTEST_SKIP() << "built without libwebsockets";
        }
    }
};

TEST_F(HostileConnectionTest, PeersThatReadNothingAreCutOff) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(
        2,
        [](MatchServerSettings& settings) {
            settings.hello_within_s = 30.0;
            settings.state_bytes_per_s = 50e6;
        },
        [](ListenerSettings& settings) {
            settings.slow_after_s = 0.5;
            settings.kernel_buffer_bytes = 4096;
        });
    test::LoopbackPeer& other = match.add_peer(1);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    RawSocket deaf(match.listener().port());
    ASSERT_TRUE(deaf.is_connected);
    std::vector<std::byte> hello;
    write_message(MatchHello{.person = 9, .digests = other.settings.digests, .token = {}}, hello);
    ASSERT_LT(hello.size(), 126U);
    deaf.write_frame(hello);
    EXPECT_TRUE(match.run_until(15.0, [&] { return match.listener().counts().ended_slow > 0; }));
    EXPECT_LE(match.listener().counts().most_queued_bytes, SendQueue::k_most_bytes);
    ASSERT_TRUE(match.run_until(5.0, [&] { return match.server->seats().taken() == 1; }));
    EXPECT_TRUE(other.plays());
    EXPECT_EQ(other.different, 0U);
    EXPECT_EQ(other.peer->states(), 1U);
}

// A connection that sends one message, or none. True if the server ends it.
bool is_closed_after(LoopbackMatch& match, const std::vector<std::byte>& message) {
    struct Raw final : LinkHandler {
        void opened() override {}
        void received(std::span<const std::byte> /*message*/) override {}
        void closed(std::string_view /*why*/) override { is_closed = true; }
        bool is_closed = false;
    } raw;
    const std::unique_ptr<Link> link = match.link();
    match.others = [&] { link->poll(0.0, raw); };
    if (!message.empty()) {
        link->send(Delivery::reliable, message);
    }
    const bool is_closed = match.run_until(10.0, [&] { return raw.is_closed; });
    match.others = nullptr;
    return is_closed;
}

TEST_F(HostileConnectionTest, MessagesThatAreNoneEndTheConnection) {
    LoopbackMatch match(2);
    EXPECT_TRUE(is_closed_after(match, std::vector<std::byte>(10, std::byte{0xff})));
    EXPECT_TRUE(is_closed_after(match, std::vector<std::byte>(3000, std::byte{5})));
    EXPECT_TRUE(is_closed_after(match, {static_cast<std::byte>(NetKind::joined), std::byte{1}}));
    EXPECT_TRUE(is_closed_after(match, {static_cast<std::byte>(NetKind::hello), std::byte{1}}));
    EXPECT_EQ(match.server->counts().bad_messages, 3U);
    EXPECT_EQ(match.listener().counts().bad_messages, 1U);
}

TEST_F(HostileConnectionTest, ConnectionsThatSayNothingAreClosed) {
    LoopbackMatch match(2, [](MatchServerSettings& settings) { settings.hello_within_s = 0.5; });
    EXPECT_TRUE(is_closed_after(match, {}));
}

TEST_F(HostileConnectionTest, WhoJoinsAgainAndAgainIsRefusedAndOthersPlayOn) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(3, [](MatchServerSettings& settings) { settings.joins.at_once = 5.0; });
    test::LoopbackPeer& other = match.add_peer(1);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    test::LoopbackPeer& again = match.add_peer(2);
    match.others = [&] {
        if (again.plays() || again.peer->stage() == PeerStage::ended) {
            again.connect(match.link());
        }
    };
    match.run(2.0);
    const MatchServerCounts& counts = match.server->counts();
    EXPECT_GT(counts.refused[static_cast<std::size_t>(NetRefusal::busy)], 5U);
    EXPECT_LE(counts.states, 15U);  // 5, and 4 a second
    EXPECT_TRUE(other.plays());
    EXPECT_EQ(other.different, 0U);
    EXPECT_EQ(other.peer->states(), 1U);
    EXPECT_GT(other.compared, 60U);
    RecordProperty("states", static_cast<int>(counts.states));
    RecordProperty("joins_refused",
                   static_cast<int>(counts.refused[static_cast<std::size_t>(NetRefusal::busy)]));
    RecordProperty("longest_poll_us", static_cast<int>(1e6 * match.longest_poll_s));
}

TEST_F(HostileConnectionTest, NoMoreConnectionsThanTheLimitAreOpened) {
    LoopbackMatch match(2, {}, [](ListenerSettings& settings) { settings.most_links = 4; });
    std::vector<std::unique_ptr<RawSocket>> sockets;
    for (int i = 0; i < 12; ++i) {  // three of each address, as many as it may have
        const std::string from = "127.0.0." + std::to_string(2 + i % 4);
        sockets.push_back(std::make_unique<RawSocket>(match.listener().port(), from.c_str()));
    }
    EXPECT_TRUE(match.run_until(4.0, [&] { return match.listener().counts().refused > 0; }));
    EXPECT_EQ(match.listener().counts().opened, 4U);
}

}  // namespace
}  // namespace handhold::hostile_peer_test
