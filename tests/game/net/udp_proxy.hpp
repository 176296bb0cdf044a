#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/random.hpp"

namespace handhold::test {

// A UDP socket of the loopback interface that sends what a test says.
class RawUdp {
  public:
    explicit RawUdp(const char* from = "127.0.0.1") : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in own = place(0);
        ::inet_pton(AF_INET, from, &own.sin_addr);
        ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own));
    }
    ~RawUdp() { ::close(socket_); }
    RawUdp(const RawUdp&) = delete;
    RawUdp& operator=(const RawUdp&) = delete;

    int port() const {
        sockaddr_in own{};
        socklen_t size = sizeof(own);
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
        return ntohs(own.sin_port);
    }
    void send(int port, std::span<const std::uint8_t> bytes) {
        const sockaddr_in to = place(port);
        ::sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    }
    // The next datagram, and the port that it comes from. False: none has come.
    bool receive(std::vector<std::uint8_t>& bytes, int& from_port) {
        sockaddr_in from{};
        socklen_t size = sizeof(from);
        bytes.resize(2048);
        const ssize_t got = ::recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                       reinterpret_cast<sockaddr*>(&from), &size);
        bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        from_port = ntohs(from.sin_port);
        return got >= 0;
    }

  private:
    static sockaddr_in place(int port) {
        sockaddr_in out{};
        out.sin_family = AF_INET;
        out.sin_port = htons(static_cast<std::uint16_t>(port));
        ::inet_pton(AF_INET, "127.0.0.1", &out.sin_addr);
        return out;
    }
    int socket_;
};

// Between one peer and a server. Poll it in each round.
class UdpProxy {
  public:
    explicit UdpProxy(int server_port) : server_port_(server_port), up_(new RawUdp()) {}

    int port() const { return down_.port(); }
    std::string url(const std::string& server_url) const {
        return "quic://127.0.0.1:" + std::to_string(port()) +
               server_url.substr(server_url.find('#'));
    }
    // From now on the server sees another address.
    void rebind() { up_ = std::make_unique<RawUdp>(); }
    void poll() {
        std::vector<std::uint8_t> bytes;
        int from = 0;
        while (down_.receive(bytes, from)) {
            peer_port_ = from;
            bytes_up += bytes.size();
            if (seen_before) {
                seen_before(bytes);
            }
            if (passes(passed_up)) {
                up_->send(server_port_, bytes);
            }
            if (seen_up) {
                seen_up(bytes);
            }
        }
        while (up_->receive(bytes, from)) {
            bytes_down += bytes.size();
            const bool has_room =
                down_bytes_per_s >= k_wide || queued_bytes_ + bytes.size() < k_most_queued_bytes;
            if (!is_deaf && has_room && passes(passed_down)) {
                queued_bytes_ += bytes.size();
                queue_.push_back(bytes);
            }
        }
        const double now_s = wall_s();
        credit_ = std::min(credit_ + (now_s - polled_s_) * down_bytes_per_s, 1500.0);
        polled_s_ = now_s;
        while (!queue_.empty() && credit_ >= static_cast<double>(queue_.front().size())) {
            down_.send(peer_port_, queue_.front());
            queued_bytes_ -= queue_.front().size();
            if (down_bytes_per_s < k_wide) {
                credit_ -= static_cast<double>(queue_.front().size());
            }
            queue_.pop_front();
        }
    }

    static constexpr double k_wide = 1e12;
    double loss = 0.0;
    double down_bytes_per_s = k_wide;  // to the peer; what waits for it is in a queue
    bool is_deaf = false;              // nothing comes back to the peer
    // Called before, and after, a datagram of the peer's is passed on.
    std::function<void(const std::vector<std::uint8_t>&)> seen_before;
    std::function<void(const std::vector<std::uint8_t>&)> seen_up;
    std::uint64_t passed_up = 0;
    std::uint64_t passed_down = 0;
    std::uint64_t lost = 0;
    std::uint64_t bytes_up = 0;
    std::uint64_t bytes_down = 0;

  private:
    bool passes(std::uint64_t& count) {
        const bool passes = random_.between(0.0, 1.0) >= loss;
        count += passes ? 1U : 0U;
        lost += passes ? 0U : 1U;
        return passes;
    }

    static double wall_s() {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    }
    static constexpr std::size_t k_most_queued_bytes = std::size_t{8} << 10U;

    std::deque<std::vector<std::uint8_t>> queue_;
    std::size_t queued_bytes_ = 0;
    double credit_ = 0.0;
    double polled_s_ = 0.0;
    int server_port_;
    int peer_port_ = 0;
    RawUdp down_;
    std::unique_ptr<RawUdp> up_;
    Random random_{5};
};

}  // namespace handhold::test
