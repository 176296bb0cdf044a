// Hosts and ports of URLs, and matches over IPv6.
#include "game/net/host_port.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "game/net/quic_socket.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/game/net/quic_test.hpp"

namespace handhold::host_port_test {
namespace {

using test::add_peer;
using test::LoopbackMatch;
using Bytes = std::array<std::uint8_t, 16>;

std::string text_of(const Bytes& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    inet_ntop(AF_INET6, address.data(), text.data(), text.size());
    return text.data();
}

RC_GTEST_PROP(HostPort, IsReadAsItIsWritten, (const Bytes& address)) {
    const int port = *rc::gen::inRange(1, 65536);
    const std::string v4 = std::to_string(address[0]) + "." + std::to_string(address[1]) + ".0.7";
    for (const std::string& host : {text_of(address), v4, std::string("a.b-c.example")}) {
        const auto read = read_host_port(HostPort{host, port}.text(), 0);
        RC_ASSERT(read.has_value());
        RC_ASSERT(read->host == host);
        RC_ASSERT(read->port == port);
    }
    const auto without = read_host_port("[" + text_of(address) + "]", 443);
    RC_ASSERT(without.has_value());
    RC_ASSERT(without->port == 443);
}

TEST(HostPort, IsNothingElse) {
    for (const char* const text :
         {"", ":1", "a", "a:", "a:0", "a:65536", "a:1x", "a:-1", "::1", "::1:80", "[::1]", "[::1",
          "[]:1", "[127.0.0.1]:1", "[a]:1", "[::1]x1", "[::1]:0", "[::1]80", "a:1:2"}) {
        EXPECT_FALSE(read_host_port(text, 0)) << text;
    }
}

// Whoever has an address of IPv6 has 2^64 of them.
RC_GTEST_PROP(CountedAddress, IsTheNetworkOfIpv6, (const Bytes& address, const Bytes& other)) {
    Bytes same = address;
    std::ranges::copy(other.begin() + 8, other.end(), same.begin() + 8);
    RC_ASSERT(counted_address(text_of(address)) == counted_address(text_of(same)));
    Bytes elsewhere = address;
    const auto bit = *rc::gen::inRange(0, 64);
    elsewhere[static_cast<std::size_t>(bit / 8)] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    RC_ASSERT(counted_address(text_of(address)) != counted_address(text_of(elsewhere)));
}

TEST(CountedAddress, IsTheSameForIpv4InIpv6) {
    EXPECT_EQ(counted_address("10.1.2.3"), "10.1.2.3");
    EXPECT_EQ(counted_address("::ffff:10.1.2.3"), "10.1.2.3");
    EXPECT_EQ(counted_address("fd00:1:2:3:4:5:6:7"), "fd00:1:2:3::/64");
}

class Ipv6MatchTest : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

// Address of the server, host of the peers; QUIC and WebSocket in one match.
TEST_P(Ipv6MatchTest, PeersOfBothTransportsAreEqualBitForBit) {
    const std::string address = std::get<0>(GetParam());
    const std::string host = std::get<1>(GetParam());
    if (!has_quic() || !has_websocket()) {
        GTEST_SKIP() << "built without a network";
    }
    std::vector<UdpPlace> place = find_places("::1", 0);
    if (place.empty() || !UdpSocket(place.front(), 1 << 16, UdpSocket::Side::peer).is_valid()) {
        GTEST_SKIP() << "this system has no IPv6";
    }
    const auto is_there = [&](const UdpPlace& one) {
        return one.text() == address || address == "::";
    };
    if (std::ranges::none_of(find_places(host, 0), is_there)) {
        GTEST_SKIP() << host << " has no address " << address;
    }
    LoopbackMatch match(2, {}, [&](ListenerSettings& settings) { settings.address = address; });
    const std::string at = HostPort{host, match.listener().port()}.text();
    const std::string quic = match.quic_url();
    add_peer(match, 1, "quic://" + at + quic.substr(quic.find('#')));
    add_peer(match, 2, "ws://" + at);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }))
        << match.peers[0]->peer->why() << "; " << match.peers[1]->peer->why();
    ASSERT_TRUE(match.run_until(20.0, [&] {
        return std::ranges::all_of(match.peers, [](const auto& one) { return one->compared > 40; });
    }));
    for (const auto& peer : match.peers) {
        EXPECT_EQ(peer->different, 0U);
    }
    EXPECT_GT(match.listener().counts().received_datagrams, 40U);
}

// `localhost` has addresses of both families, and the server listens to one of them.
INSTANTIATE_TEST_SUITE_P(Addresses, Ipv6MatchTest,
                         testing::Values(std::tuple{"::1", "::1"}, std::tuple{"::", "::1"},
                                         std::tuple{"::", "127.0.0.1"},
                                         std::tuple{"::1", "localhost"},
                                         std::tuple{"127.0.0.1", "localhost"}));

}  // namespace
}  // namespace handhold::host_port_test
