// Attacks on a match's server from the network: what they cost those who play or want to.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "game/commands/match_commands.hpp"
#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/raw_socket.hpp"

namespace handhold::hostile_network_test {
namespace {

using test::LoopbackMatch;
using test::LoopbackPeer;
using test::RawSocket;

class HostileNetworkTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_websocket()) {
            GTEST_SKIP() << "built without libwebsockets";
        }
    }
};

TokenKey key_of_test() { return {std::vector<std::byte>(32, std::byte{7})}; }

std::vector<std::byte> packet_of_60_bytes() {
    std::vector<std::byte> message(60, std::byte{1});
    message[0] = static_cast<std::byte>(NetKind::packet);
    return message;
}

void expect_unharmed(const LoopbackPeer& other) {
    EXPECT_TRUE(other.plays());
    EXPECT_EQ(other.different, 0U);
    EXPECT_EQ(other.peer->states(), 1U);
}

TEST_F(HostileNetworkTest, AFloodWithoutAHelloEndsAtItsFirstMessage) {
    LoopbackMatch match(2);
    LoopbackPeer& other = match.add_peer(1);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    RawSocket flood(match.listener().port());
    const std::vector<std::byte> frame = RawSocket::frame(packet_of_60_bytes());
    match.others = [&] {
        flood.pour(frame);
        (void)flood.read();
    };
    EXPECT_TRUE(match.run_until(4.0, [&] { return flood.is_ended; }));
    EXPECT_EQ(match.server->counts().bad_messages, 1U);
    expect_unharmed(other);
    RecordProperty("poured", static_cast<int>(flood.poured()));
}

// Neither is a message, and libwebsockets says nothing of pings.
TEST_F(HostileNetworkTest, FloodsOfPingsAndOfPiecesAreThrottled) {
    const std::vector<std::byte> ping = RawSocket::frame(packet_of_60_bytes(), 0x89);
    const std::vector<std::byte> piece = RawSocket::frame({}, 0x00);
    for (const bool pings : {true, false}) {
        LoopbackMatch match(2);
        LoopbackPeer& other = match.add_peer(1);
        ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
        RawSocket flood(match.listener().port());
        std::string answer;
        ASSERT_TRUE(match.run_until(4.0, [&] {
            answer += flood.read();
            return answer.find(" 101 ") != std::string::npos;
        }));
        if (!pings) {
            flood.write_frame(std::span<const std::byte>(packet_of_60_bytes()).first(2), 0x02);
        }
        match.others = [&] {
            flood.pour(pings ? ping : piece);
            (void)flood.read();
        };
        match.run(3.0);
        const ListenerCounts& counts = match.listener().counts();
        EXPECT_GE(counts.throttled, 1U);
        // Three seconds of the budget, its burst, and what the kernels keep: not hundreds of MB.
        EXPECT_LT(static_cast<double>(flood.poured()), 8e6);
        expect_unharmed(other);
        RecordProperty(pings ? "pings_poured" : "pieces_poured", static_cast<int>(flood.poured()));
        RecordProperty(pings ? "pings_throttled" : "pieces_throttled",
                       static_cast<int>(counts.throttled));
        RecordProperty(pings ? "pings_longest_poll_us" : "pieces_longest_poll_us",
                       static_cast<int>(1e6 * match.longest_poll_s));
    }
}

TEST_F(HostileNetworkTest, APersonWhoJoinsAgainAndAgainDoesNotUseUpTheJoinsOfOthers) {
    LoopbackMatch match(3, [](MatchServerSettings& settings) {
        settings.key = key_of_test();
        settings.joins = {4.0, 8.0};
    });
    LoopbackPeer& mallory = match.add_peer(1, issue_token(key_of_test(), "mallory", 2000));
    match.others = [&] {
        if (mallory.plays() || mallory.peer->stage() == PeerStage::ended) {
            mallory.connect(match.link());
        }
    };
    const auto refused = [&] {
        return match.server->counts().refused[static_cast<std::size_t>(NetRefusal::busy)];
    };
    ASSERT_TRUE(match.run_until(20.0, [&] { return refused() > 10; }));
    EXPECT_LE(match.server->counts().joins, 8U);
    LoopbackPeer& ann = match.add_peer(2, issue_token(key_of_test(), "ann", 2000));
    EXPECT_TRUE(match.run_until(10.0, [&] { return ann.plays(); })) << ann.peer->why();
}

TEST_F(HostileNetworkTest, AnAddressThatJoinsAgainAndAgainDoesNotUseUpTheJoinsOfOthers) {
    LoopbackMatch match(12, [](MatchServerSettings& settings) {
        settings.joins = {0.5, 8.0};
        settings.joins_of_address = {0.1, 4.0};
    });
    std::vector<std::byte> hello;
    const auto settings = LoopbackPeer(12, 99).settings;
    std::vector<std::unique_ptr<RawSocket>> sockets;
    for (std::uint64_t i = 0; i < 8; ++i) {
        sockets.push_back(std::make_unique<RawSocket>(match.listener().port(), "127.0.0.2"));
        ASSERT_TRUE(sockets.back()->is_connected);
        write_message(MatchHello{.person = 100 + i, .digests = settings.digests, .token = {}},
                      hello);
        ASSERT_LT(hello.size(), 126U);
        sockets.back()->write_frame(hello);
    }
    ASSERT_TRUE(match.run_until(4.0, [&] {
        return match.server->counts().refused[static_cast<std::size_t>(NetRefusal::busy)] >= 4;
    }));
    EXPECT_EQ(match.server->counts().joins, 4U);
    LoopbackPeer& other = match.add_peer(1);
    EXPECT_TRUE(match.run_until(10.0, [&] { return other.plays(); })) << other.peer->why();
}

TEST_F(HostileNetworkTest, AnAddressThatOnlyConnectsLeavesRoomForOthers) {
    const ListenerSettings of_serve = listener_settings({});
    for (const bool upgrades : {false, true}) {
        for (const std::size_t most_links : {of_serve.most_links, std::size_t{16}}) {
            LoopbackMatch match(2, {}, [&](ListenerSettings& settings) {
                settings.most_links = most_links;
                settings.most_of_address = of_serve.most_of_address;
            });
            std::vector<std::unique_ptr<RawSocket>> sockets;
            for (int i = 0; i < 80; ++i) {
                sockets.push_back(
                    std::make_unique<RawSocket>(match.listener().port(), "127.0.0.2", upgrades));
            }
            match.run(0.5);
            LoopbackPeer& other = match.add_peer(1);
            EXPECT_TRUE(match.run_until(4.0, [&] { return other.plays(); })) << other.peer->why();
            EXPECT_GE(match.listener().counts().refused, 80 - most_links * 3 / 4);
        }
    }
}

TEST_F(HostileNetworkTest, TokenThatExpiredMeanwhileBringsItsPlayerBackAndNobodyElse) {
    std::int64_t today = 1000;
    LoopbackMatch match(3, [&](MatchServerSettings& settings) {
        settings.key = key_of_test();
        settings.today = [&today] { return today; };
    });
    const std::string token = issue_token(key_of_test(), "ann", 1500);
    LoopbackPeer& ann = match.add_peer(1, token);
    ASSERT_TRUE(match.run_until(20.0, [&] { return ann.plays(); }));
    today = 2000;
    LoopbackPeer& thief = match.add_peer(2, token);
    ASSERT_TRUE(match.run_until(10.0, [&] { return thief.peer->stage() == PeerStage::ended; }));
    EXPECT_EQ(thief.peer->why(), "the token has expired");
    EXPECT_TRUE(ann.plays());
    ann.connect(match.link());  // the old connection is cut
    EXPECT_TRUE(match.run_until(10.0, [&] { return ann.plays(); })) << ann.peer->why();
    EXPECT_EQ(ann.peer->states(), 2U);
    EXPECT_EQ(match.server->counts().returns, 1U);
    // It is cut again while the state is on its way.
    ann.connect(match.link());
    ASSERT_TRUE(match.run_until(10.0, [&] { return ann.peer->stage() == PeerStage::joining; }));
    ann.connect(match.link());
    EXPECT_TRUE(match.run_until(10.0, [&] { return ann.plays(); })) << ann.peer->why();
    // Whoever has left needs a good token.
    ann.peer->leave();
    ASSERT_TRUE(match.run_until(10.0, [&] { return match.server->seats().taken() == 0; }));
    ann.connect(match.link());
    ASSERT_TRUE(match.run_until(10.0, [&] { return ann.peer->stage() == PeerStage::ended; }));
    EXPECT_EQ(ann.peer->why(), "the token has expired");
}

TEST_F(HostileNetworkTest, MetricsAreAnsweredTenTimesASecondAndHealthAlways) {
    LoopbackMatch match(2);
    int good = 0;
    int refused = 0;
    int healthy = 0;
    const auto ask = [&](const std::string& path) {
        RawSocket socket(match.listener().port(), "127.0.0.1", false);
        socket.write_text("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        std::string answer;
        (void)match.run_until(4.0, [&] {
            answer += socket.read();
            return socket.is_ended;
        });
        EXPECT_TRUE(socket.is_ended) << "one answer a connection";
        good +=
            answer.starts_with("HTTP/1.1 200") && answer.find("handhold_tick ") != std::string::npos
                ? 1
                : 0;
        refused += answer.starts_with("HTTP/1.1 429") ? 1 : 0;
        healthy += answer.starts_with("HTTP/1.1 200") && answer.ends_with("ok\n") ? 1 : 0;
    };
    for (int i = 0; i < 30; ++i) {
        ask("/metrics");
    }
    ask("/health");
    EXPECT_GE(good, 10);
    EXPECT_GE(refused, 3);
    EXPECT_EQ(good + refused, 30);
    EXPECT_EQ(healthy, 1);
}

// What throws ends its connection, and is told.
TEST_F(HostileNetworkTest, AFaultInAHandlerEndsTheConnectionAndIsTold) {
    struct Faulty final : ListenerHandler {
        void opened(LinkId, std::string_view) override {}
        void received(LinkId, std::span<const std::byte>) override {
            throw std::runtime_error("a fault of the test");
        }
        void closed(LinkId link, LinkEnd) override { ended = link; }
        HttpAnswer get(std::string_view) override { return {}; }
        void failed(LinkId link, std::string_view what) override {
            told = std::to_string(link) + " " + std::string(what);
        }
        LinkId ended = 0;
        std::string told;
    } handler;
    const std::unique_ptr<Listener> listener = std::move(open_listener({}).value());
    RawSocket socket(listener->port());
    socket.write_frame(packet_of_60_bytes());
    for (int i = 0; i < 200 && handler.ended == 0; ++i) {
        listener->poll(0.01, handler);
    }
    EXPECT_EQ(handler.ended, 1U);
    EXPECT_EQ(handler.told, "1 a fault of the test");
    EXPECT_EQ(listener->counts().failed, 1U);
}

}  // namespace
}  // namespace handhold::hostile_network_test
