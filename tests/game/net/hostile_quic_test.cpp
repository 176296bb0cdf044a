// Attacks over UDP on a match's server: what they cost those who play or want to.
#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "game/net/send_queue.hpp"
#include "game/net/transport_kinds.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/quic_test.hpp"
#include "tests/game/net/udp_proxy.hpp"

namespace handhold::hostile_quic_test {
namespace {

using test::add_peer;
using test::expect_unharmed;
using test::LoopbackMatch;
using test::LoopbackPeer;
using test::RawUdp;
using test::UdpProxy;

class HostileQuicTest : public test::QuicTest {};

// The header of a client's first packet, and noise that no key fits.
std::vector<std::uint8_t> false_initial(test::Random& random) {
    std::vector<std::uint8_t> out(1200);
    for (std::uint8_t& byte : out) {
        byte = static_cast<std::uint8_t>(random.between(0.0, 256.0));
    }
    const std::vector<std::uint8_t> header = {0xc3, 0, 0, 0, 1, 8};
    std::ranges::copy(header, out.begin());
    out[14] = 8;     // bytes of the source's connection ID
    out[23] = 0;     // of the token
    out[24] = 0x44;  // length of the rest, in two bytes
    out[25] = 0x96;
    return out;
}

TEST_F(HostileQuicTest, AFloodOfFirstPacketsDelaysNobodyAndOthersJoin) {
    LoopbackMatch match(3);
    LoopbackPeer& other = add_peer(match, 1, match.quic_url());
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    RawUdp flood("127.0.0.2");
    test::Random random(3);
    std::uint64_t sent_bytes = 0;
    std::uint64_t got_bytes = 0;
    match.others = [&] {
        for (int i = 0; i < 100; ++i) {
            const std::vector<std::uint8_t> packet = false_initial(random);
            sent_bytes += packet.size();
            flood.send(match.listener().port(), packet);
        }
        std::vector<std::uint8_t> answer;
        int from = 0;
        while (flood.receive(answer, from)) {
            got_bytes += answer.size();
        }
    };
    const auto is_flooded = [&match] {
        const ListenerCounts& counts = match.listener().counts();
        return counts.retries > 100 && counts.stray_datagrams > 1000;
    };
    EXPECT_TRUE(match.run_until(60.0, is_flooded));
    LoopbackPeer& late = add_peer(match, 2, match.quic_url());
    EXPECT_TRUE(match.run_until(20.0, [&] { return late.plays(); })) << late.peer->why();
    match.run(1.0);
    expect_unharmed(match, other);
    EXPECT_EQ(late.different, 0U);
    const ListenerCounts& counts = match.listener().counts();
    EXPECT_EQ(counts.opened, 2U);
    EXPECT_LT(got_bytes, sent_bytes);  // the flood is not amplified
    RecordProperty("first_packets", static_cast<int>(sent_bytes / 1200));
    RecordProperty("retries", static_cast<int>(counts.retries));
    RecordProperty("longest_poll_us", static_cast<int>(1e6 * match.longest_poll_s));
}

struct NoHandler final : ListenerHandler {
    void opened(LinkId, std::string_view) override { ++opened_links; }
    void received(LinkId, std::span<const std::byte>) override {}
    void closed(LinkId, LinkEnd) override {}
    HttpAnswer get(std::string_view) override { return {}; }
    void failed(LinkId, std::string_view) override { ++failures; }
    int opened_links = 0;
    int failures = 0;
};

// An empty one once ended the program.
TEST_F(HostileQuicTest, DatagramsOfEachLengthAndKindAreNone) {
    NoHandler handler;
    const std::unique_ptr<Listener> listener = std::move(open_listener({}).value());
    RawUdp sender;
    test::Random random(1);
    std::vector<std::size_t> sizes = {1199, 1200, 1201, 1472, 2048};
    for (std::size_t size = 0; size < 64; ++size) {
        sizes.push_back(size);
    }
    std::uint64_t sent = 0;
    for (const std::size_t size : sizes) {
        for (unsigned first = 0; first < 256; first += 3) {
            std::vector<std::uint8_t> bytes(size);
            for (std::uint8_t& byte : bytes) {
                byte = static_cast<std::uint8_t>(random.between(0.0, 256.0));
            }
            // QUIC, another version, or the question for versions; then sizes of connection IDs.
            const std::array<std::uint8_t, 4> versions = {1, 0, 9,
                                                          static_cast<std::uint8_t>(first)};
            const std::vector<std::uint8_t> header = {
                static_cast<std::uint8_t>(first),     0, 0, 0, versions[first % 4],
                static_cast<std::uint8_t>(first % 21)};
            std::copy_n(header.begin(), std::min(header.size(), size), bytes.begin());
            sender.send(listener->port(), bytes);
            ++sent;
            if (sent % 16 == 0) {
                listener->poll(0.0, handler);
            }
        }
    }
    listener->poll(0.0, handler);
    const ListenerCounts& counts = listener->counts();
    EXPECT_EQ(counts.received_datagrams, sent);
    EXPECT_LE(counts.sent_datagram_bytes, counts.received_datagram_bytes);
    EXPECT_EQ(handler.opened_links, 0);
    EXPECT_EQ(handler.failures, 0);
    RecordProperty("sent", static_cast<int>(sent));
    RecordProperty("stray", static_cast<int>(counts.stray_datagrams));
}

// A handshake costs a millisecond of the match's thread.
TEST_F(HostileQuicTest, FewHandshakesBeginInOnePoll) {
    NoHandler handler;
    const std::unique_ptr<Listener> listener = std::move(open_listener({}).value());
    RawUdp sender;
    test::Random random(5);
    for (int i = 0; i < 7; ++i) {
        sender.send(listener->port(), false_initial(random));
    }
    listener->poll(0.0, handler);
    EXPECT_EQ(listener->counts().retries, 3U);
}

// The attacker writes somebody else's address on a good first packet.
TEST_F(HostileQuicTest, AnAddressThatNeverAnswersGetsAtMostThreeTimesWhatCame) {
    LoopbackMatch match(2);
    UdpProxy proxy(match.listener().port());
    proxy.is_deaf = true;
    LoopbackPeer& deaf = add_peer(match, 1, proxy.url(match.quic_url()));
    match.others = [&proxy] { proxy.poll(); };
    match.run(3.0 * test::k_clock_rate);  // three seconds of the wall's clock
    EXPECT_EQ(deaf.peer->stage(), PeerStage::connecting);
    EXPECT_GT(proxy.bytes_up, 2000U);
    EXPECT_GT(proxy.bytes_down, 500U);
    EXPECT_LE(proxy.bytes_down, 3 * proxy.bytes_up);
    EXPECT_EQ(match.listener().counts().opened, 0U);
    RecordProperty("bytes_up", static_cast<int>(proxy.bytes_up));
    RecordProperty("bytes_down", static_cast<int>(proxy.bytes_down));
}

// A connection whose messages the test writes.
struct RawPeer final : LinkHandler {
    explicit RawPeer(const std::string& url) : link(std::move(open_link(url).value())) {}
    void opened() override { is_open = true; }
    void received(std::span<const std::byte> message) override {
        kinds.push_back(kind_of(message));
    }
    void closed(std::string_view /*why*/) override { is_closed = true; }

    std::unique_ptr<Link> link;
    std::vector<std::optional<NetKind>> kinds;
    bool is_open = false;
    bool is_closed = false;
};

bool is_closed_after(LoopbackMatch& match, std::size_t bytes, std::byte value) {
    RawPeer raw(match.quic_url());
    match.others = [&raw] { raw.link->poll(0.0, raw); };
    if (bytes > 0) {
        raw.link->send(Delivery::reliable, std::vector<std::byte>(bytes, value));
    }
    const bool is_closed = match.run_until(10.0, [&] { return raw.is_closed; });
    match.others = nullptr;
    return is_closed;
}

TEST_F(HostileQuicTest, MessagesThatAreNoneEndTheConnection) {
    LoopbackMatch match(2, [](MatchServerSettings& settings) { settings.hello_within_s = 1.0; });
    EXPECT_TRUE(is_closed_after(match, 10, std::byte{0xff}));
    EXPECT_TRUE(is_closed_after(match, 3000, std::byte{5}));
    EXPECT_TRUE(is_closed_after(match, 0, std::byte{}));  // says nothing
    EXPECT_EQ(match.server->counts().bad_messages, 1U);
    EXPECT_EQ(match.listener().counts().bad_messages, 1U);
}

TEST_F(HostileQuicTest, AFloodingPeerIsNotReadForAWhile) {
    LoopbackMatch match(3);
    LoopbackPeer& other = add_peer(match, 1, match.quic_url());
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    RawPeer flood(match.quic_url());
    std::vector<std::byte> hello;
    write_message(MatchHello{.person = 9, .digests = other.settings.digests, .token = {}}, hello);
    flood.link->send(Delivery::reliable, hello);
    match.others = [&flood] { flood.link->poll(0.0, flood); };
    ASSERT_TRUE(match.run_until(
        10.0, [&] { return std::ranges::count(flood.kinds, NetKind::welcome) == 1; }));
    std::vector<std::byte> packet(60, std::byte{1});
    packet[0] = static_cast<std::byte>(NetKind::packet);
    std::uint64_t sent = 0;
    match.others = [&] {
        // More than the burst, so that a slow machine's rounds exceed the rate too.
        for (int i = 0; i < 400; ++i) {
            flood.link->send(Delivery::newest, packet);
            ++sent;
        }
        flood.link->poll(0.0, flood);
    };
    EXPECT_TRUE(match.run_until(30.0, [&match] {
        const ListenerCounts& counts = match.listener().counts();
        return counts.throttled >= 1 && counts.unread_datagrams > 0;
    }));
    expect_unharmed(match, other);
    const ListenerCounts& counts = match.listener().counts();
    RecordProperty("sent", static_cast<int>(sent));
    RecordProperty("throttled", static_cast<int>(counts.throttled));
    RecordProperty("unread", static_cast<int>(counts.unread_datagrams));
    RecordProperty("longest_poll_us", static_cast<int>(1e6 * match.longest_poll_s));
}

TEST_F(HostileQuicTest, MessagesOfOneDatagramAreAllCharged) {
    NoHandler handler;
    const ListenerSettings settings;
    const std::unique_ptr<Listener> listener = std::move(open_listener(settings).value());
    RawPeer flood(listener->urls().back());
    const std::vector<std::byte> message(1, std::byte{1});
    const auto wall_s = [] { return test::match_clock_s() / test::k_clock_rate; };
    const double begin_s = wall_s();
    while (wall_s() < begin_s + 3.0) {
        for (int i = 0; flood.is_open && i < 1000 && flood.link->queued_bytes() < 30'000; ++i) {
            flood.link->send(Delivery::reliable, message);
        }
        flood.link->poll(0.001, flood);
        listener->poll(0.0, handler);
    }
    const double burst_s = wall_s() - begin_s + settings.budget.burst_s;
    const ListenerCounts& counts = listener->counts();
    // Some datagrams, of 400 messages each, may wait for one that was lost.
    constexpr double k_most_at_once = 10 * 400.0;
    EXPECT_GE(counts.throttled, 1U);
    RecordProperty("received", static_cast<int>(counts.received_messages));
    EXPECT_LE(static_cast<double>(counts.received_messages),
              burst_s * settings.budget.messages_per_s + k_most_at_once);
}

TEST_F(HostileQuicTest, PeersThatReadNothingAreCutOff) {
    LoopbackMatch match(
        3, [](MatchServerSettings& settings) { settings.hello_within_s = 30.0; },
        [](ListenerSettings& settings) { settings.slow_after_s = 0.5; });
    LoopbackPeer& other = add_peer(match, 1, match.quic_url());
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    RawPeer deaf(match.quic_url());
    std::vector<std::byte> hello;
    write_message(MatchHello{.person = 9, .digests = other.settings.digests, .token = {}}, hello);
    match.others = [&deaf] { deaf.link->poll(0.0, deaf); };
    ASSERT_TRUE(match.run_until(10.0, [&] { return deaf.is_open; }));
    deaf.link->send(Delivery::reliable, hello);
    match.others = nullptr;
    EXPECT_TRUE(match.run_until(15.0, [&] { return match.listener().counts().ended_slow > 0; }));
    EXPECT_LE(match.listener().counts().most_queued_bytes, SendQueue::k_most_bytes);
    EXPECT_TRUE(match.run_until(5.0, [&] { return match.server->seats().taken() == 1; }));
    match.run(1.0);
    expect_unharmed(match, other);
}

// Whoever was forgotten by the server learns it from an answer to what they send.
TEST_F(HostileQuicTest, APeerWhoseConnectionIsForgottenIsTold) {
    LoopbackMatch match(2);
    UdpProxy proxy(match.listener().port());
    LoopbackPeer& peer = add_peer(match, 1, proxy.url(match.quic_url()));
    match.others = [&proxy] { proxy.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    proxy.is_deaf = true;  // the server's last words are lost
    match.server->drain();
    ASSERT_TRUE(match.run_until(10.0, [&] { return match.server->is_drained(); }));
    EXPECT_TRUE(peer.plays());
    proxy.is_deaf = false;
    EXPECT_TRUE(match.run_until(4.0, [&] { return peer.peer->stage() == PeerStage::ended; }));
}

}  // namespace
}  // namespace handhold::hostile_quic_test
