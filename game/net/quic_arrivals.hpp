#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "game/net/join_limits.hpp"
#include "game/net/quic_connection.hpp"
#include "game/net/quic_socket.hpp"

namespace handhold {

// Decides about datagrams that belong to no connection. Keeps nothing of their senders: what a
// stranger sends costs at most an answer that is not longer than it.
class QuicArrivals {
  public:
    // While so many handshakes wait for an address to answer, or many have begun of late, further
    // ones begin with a Retry.
    static constexpr std::size_t k_most_half_open = 8;
    // Answers to strangers in one poll: Retry, other version, reset.
    static constexpr int k_most_answers = 32;
    // Handshakes that begin in one poll: they delay a tick by so many milliseconds at most. Whoever
    // comes next tries again within half a second.
    static constexpr int k_most_begun = 4;

    // Both must outlive this.
    QuicArrivals(UdpSocket& socket, const UdpPlace& own);

    void begin_poll();
    // The connection ID that a datagram is for; empty: none can be read.
    std::string id_of(const UdpPlace& from, std::span<const std::uint8_t> datagram);
    // A datagram that is for no connection. nullopt: it begins none, or not yet.
    std::optional<QuicArrival> admit(const UdpPlace& from, std::span<const std::uint8_t> datagram,
                                     std::size_t half_open);
    // Tells an arrival that the server takes no more connections.
    void refuse(const QuicArrival& arrival);

    // Of tokens and resets; chosen at random when the server begins.
    const QuicSecret& secret() const { return secret_; }
    std::uint64_t retries() const { return retries_; }

  private:
    bool check_token(QuicArrival& arrival) const;
    void send_retry(const QuicArrival& arrival);
    void send_reset(const UdpPlace& to, std::span<const std::uint8_t> datagram);
    bool may_answer();

    UdpSocket& socket_;
    const UdpPlace& own_;
    QuicSecret secret_{};
    JoinLimits of_strangers_;  // handshakes, all together
    JoinLimits of_addresses_;  // likewise, of addresses that are known to be their peer's
    double refilled_s_ = 0.0;
    int answers_ = 0;
    int begun_ = 0;
    std::uint64_t retries_ = 0;
};

}  // namespace handhold
