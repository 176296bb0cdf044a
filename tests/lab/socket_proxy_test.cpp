// The proxy of `handhold-lab match --sockets` and `handhold-lab proxy`, with plain datagrams and
// bytes. Bounds of the wall's clock are lower ones only: a busy machine may be slow, never early.
#include "tools/lab/socket_proxy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tools/lab/loopback_socket.hpp"

namespace handhold::lab::socket_proxy_test {
namespace {

constexpr double k_longest_s = 20.0;

struct BoundSocket {
    Descriptor socket;
    int port = 0;
};
BoundSocket bound(int type) {
    BoundSocket out{open_socket(type), 0};
    out.port = bind_to_any_port(out.socket);
    return out;
}

struct Arrival {
    std::uint32_t number = 0;
    double after_s = 0.0;
};
// What a client's numbered datagrams become that a server sends back.
struct Echoes {
    std::vector<Arrival> there;
    std::vector<Arrival> back;
    ProxyCounts counts;
};
Echoes exchange_datagrams(const NetworkTraits& traits, std::uint64_t seed, std::uint32_t count) {
    const BoundSocket server = bound(SOCK_DGRAM);
    const BoundSocket client = bound(SOCK_DGRAM);
    Result<std::unique_ptr<SocketProxy>> proxy =
        open_proxy(ProxyKind::udp, server.port, traits, seed);
    const sockaddr_in to = loopback_address(proxy.value()->port());
    std::vector<double> sent_s(count);
    Echoes out;
    const auto take = [&](const BoundSocket& at, std::vector<Arrival>& arrivals, bool answers) {
        std::uint32_t number = 0;
        sockaddr_in from{};
        socklen_t size = sizeof(from);
        while (::recvfrom(at.socket.get(), &number, sizeof(number), 0, general(from), &size) ==
               sizeof(number)) {
            arrivals.push_back({number, steady_now_s() - sent_s[number]});
            if (answers) {
                ::sendto(at.socket.get(), &number, sizeof(number), 0, general(from), size);
            }
        }
    };
    const double begin_s = steady_now_s();
    double last_s = begin_s;  // of anything that was sent or arrived
    for (std::uint32_t next = 0; steady_now_s() < begin_s + k_longest_s;) {
        const std::size_t before = out.there.size() + out.back.size();
        // About 100 are on their way, so that the systems' buffers have place for all at once.
        constexpr double k_between_s = 0.0005;
        if (next < count && (next == 0 || steady_now_s() > sent_s[next - 1] + k_between_s)) {
            sent_s[next] = last_s = steady_now_s();
            ::sendto(client.socket.get(), &next, sizeof(next), 0, general(to), sizeof(to));
            ++next;
        }
        proxy.value()->poll(0.001);
        take(server, out.there, true);
        take(client, out.back, false);
        if (out.there.size() + out.back.size() != before) {
            last_s = steady_now_s();
        }
        constexpr double k_quiet_s = 0.3;
        if (next == count && steady_now_s() > last_s + k_quiet_s) {
            break;
        }
    }
    out.counts = proxy.value()->counts();
    return out;
}

// Bounds: 4 standard deviations of the binomial distribution.
TEST(SocketProxy, DatagramsAreDelayedLostDoubledAndOvertaken) {
    constexpr std::uint32_t k_count = 1500;
    const NetworkTraits traits{.delay_s = 0.03, .jitter_s = 0.02, .loss = 0.1, .duplication = 0.05};
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Echoes echoes = exchange_datagrams(traits, seed, k_count);
        const auto pieces = static_cast<double>(echoes.counts.pieces);
        EXPECT_EQ(echoes.counts.flows, 1U);
        EXPECT_NEAR(static_cast<double>(echoes.counts.lost) / pieces, 0.1,
                    4.0 * std::sqrt(0.1 * 0.9 / pieces));
        EXPECT_NEAR(static_cast<double>(echoes.counts.doubled) / pieces, 0.9 * 0.05,
                    4.0 * std::sqrt(0.045 * 0.955 / pieces));
        EXPECT_EQ(echoes.there.size() + echoes.back.size(),
                  echoes.counts.pieces - echoes.counts.lost + echoes.counts.doubled);
        EXPECT_GT(echoes.counts.overtaken, 100U);
        EXPECT_FALSE(std::ranges::is_sorted(echoes.there, {}, &Arrival::number));
        for (const Arrival& arrival : echoes.there) {
            EXPECT_GE(arrival.after_s, 0.03);
        }
        for (const Arrival& arrival : echoes.back) {
            EXPECT_GE(arrival.after_s, 0.06);
        }
    }
}

TEST(SocketProxy, DatagramsOfAPerfectNetworkAllArriveInOrder) {
    const Echoes echoes = exchange_datagrams({.delay_s = 0.01, .jitter_s = 0.0}, 1, 300);
    EXPECT_EQ(echoes.there.size(), 300U);
    EXPECT_EQ(echoes.back.size(), 300U);
    EXPECT_TRUE(std::ranges::is_sorted(echoes.back, {}, &Arrival::number));
    EXPECT_EQ(echoes.counts.lost + echoes.counts.doubled + echoes.counts.overtaken, 0U);
}

// The first byte comes after a delay, all come in order, and a client that ends is seen to end.
TEST(SocketProxy, BytesOfTcpAreDelayedAndKeepTheirOrder) {
    const BoundSocket server = bound(SOCK_STREAM);
    ASSERT_EQ(::listen(server.socket.get(), 1), 0);
    const NetworkTraits traits{.delay_s = 0.05, .jitter_s = 0.02, .loss = 0.05};
    Result<std::unique_ptr<SocketProxy>> proxy = open_proxy(ProxyKind::tcp, server.port, traits, 7);
    Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in to = loopback_address(proxy.value()->port());
    ASSERT_EQ(::connect(client.get(), general(to), sizeof(to)), 0);
    std::vector<std::uint8_t> sent(200000);
    std::iota(sent.begin(), sent.end(), std::uint8_t{0});
    ::fcntl(client.get(), F_SETFL, O_NONBLOCK);
    const double begin_s = steady_now_s();
    std::size_t written = 0;
    Descriptor accepted;
    std::vector<std::uint8_t> received;
    double first_s = 0.0;
    bool has_ended = false;
    while (!has_ended && steady_now_s() < begin_s + k_longest_s) {
        if (written < sent.size()) {
            const ssize_t more =
                ::send(client.get(), sent.data() + written, sent.size() - written, MSG_NOSIGNAL);
            written += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
        } else if (client.is_open()) {
            client = Descriptor();
        }
        proxy.value()->poll(0.001);
        if (!accepted.is_open()) {
            accepted = Descriptor(::accept4(server.socket.get(), nullptr, nullptr, SOCK_NONBLOCK));
        }
        std::array<std::uint8_t, 4096> buffer{};
        const ssize_t got =
            accepted.is_open() ? ::recv(accepted.get(), buffer.data(), buffer.size(), 0) : -1;
        has_ended = got == 0;
        if (got > 0) {
            first_s = received.empty() ? steady_now_s() - begin_s : first_s;
            received.insert(received.end(), buffer.begin(), buffer.begin() + got);
        }
    }
    EXPECT_TRUE(has_ended);
    EXPECT_GE(first_s, 0.05);
    EXPECT_EQ(received, sent);
    EXPECT_GT(proxy.value()->counts().lost, 0U);
}

}  // namespace
}  // namespace handhold::lab::socket_proxy_test
