#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <ngtcp2/ngtcp2.h>

#include "game/net/quic_socket.hpp"
#include "game/net/quic_stream.hpp"
#include "game/net/quic_tls.hpp"
#include "game/net/transport.hpp"

namespace handhold {

// Bytes of the connection IDs that a server chooses. Peers' are empty: a peer has a socket for each
// connection.
inline constexpr std::size_t k_connection_id_bytes = 8;
inline constexpr std::size_t k_datagram_bytes = 1200;  // UDP payload, at most
// A larger message of Delivery::newest goes over the stream.
inline constexpr std::size_t k_most_in_datagram = 1100;

using QuicSecret = std::array<std::uint8_t, 32>;

// The clock of QUIC: nanoseconds, monotonic.
ngtcp2_tstamp quic_now();

// What a server knows of a new connection from its first packet.
struct QuicArrival {
    ngtcp2_pkt_hd header{};
    UdpPlace own;
    UdpPlace peer;
    // With an answered Retry: the connection ID before it.
    ngtcp2_cid before_retry{};
    bool is_after_retry = false;
    bool has_token = false;  // the address is known to be the peer's
};

struct QuicConnectionSettings {
    std::size_t most_message_bytes = 1500;   // received
    std::uint64_t window_bytes = 1U << 16U;  // the stream's flow control
    double connect_within_s = 10.0;
    const QuicSecret* secret = nullptr;  // a server's, for its tokens
    // A server: packets with this ID belong, or do not belong any more, to the connection.
    std::function<void(std::span<const std::uint8_t> id, bool belongs)> id_changed;
    // A peer: a token that spares the next connection to this server a Retry.
    std::function<void(std::span<const std::uint8_t>)> token_given;
};

enum class QuicEnd : std::uint8_t {
    none,     // the connection exists
    closed,   // ended by the other side or by us, or silent
    message,  // the other side sent what is no message
    dropped,  // never a connection; nobody is told
};

// One connection: messages of both deliveries, over datagrams (RFC 9221) and one stream each way.
// Has no clock and no socket of its own. Not reentrant: messages are taken after a packet was read.
class QuicConnection {
  public:
    // A server's end. Null: the packet begins none.
    static std::unique_ptr<QuicConnection> accept(const TlsCredentials& credentials,
                                                  const QuicArrival& arrival,
                                                  QuicConnectionSettings settings);
    // A peer's end. `token`: as from token_given, or empty.
    static std::unique_ptr<QuicConnection> connect(const TlsCredentials& credentials,
                                                   const UdpPlace& own, const UdpPlace& server,
                                                   std::span<const std::uint8_t> token,
                                                   QuicConnectionSettings settings);
    ~QuicConnection();
    QuicConnection(const QuicConnection&) = delete;
    QuicConnection& operator=(const QuicConnection&) = delete;

    // Reads a datagram. `take` gets each message that is complete. False: anybody may have sent
    // it. It is not the other side's, or it has come before.
    using Take = std::function<void(std::span<const std::byte>)>;
    bool read(UdpSocket& socket, const UdpPlace& from, std::span<const std::uint8_t> datagram,
              const Take& take);
    // False: a reliable message does not fit. The receiver has not read for long.
    bool push(Delivery delivery, std::span<const std::byte> message);
    // Sends what may be sent now, and handles timers that are due.
    void write(UdpSocket& socket);
    // When `write` has something to do besides.
    ngtcp2_tstamp due() const;
    // Tells the other side, and ends the connection here. `code`: 0, or an error of QUIC.
    void close(UdpSocket& socket, std::uint64_t code = 0);

    bool is_open() const { return is_open_; }  // the handshake is complete
    // The address is the other side's: it has answered.
    bool has_valid_address() const { return has_valid_address_; }
    QuicEnd end() const { return end_; }
    const std::string& why() const { return why_; }  // one line; empty: not ended
    UdpPlace peer() const;                           // where packets are sent
    // The last address at which the other side has answered. Whoever sends a copy of its packet
    // from elsewhere, before the packet itself comes, changes `peer` but not this.
    const UdpPlace& proven_peer() const { return proven_peer_; }
    std::size_t queued_bytes() const { return newest_bytes_ + stream_.unsent_bytes(); }
    bool is_all_delivered() const { return newest_.empty() && stream_.is_all_acknowledged(); }
    // Grows with each acknowledgement of the other side: bytes of the stream, and datagrams.
    std::uint64_t acknowledged() const { return stream_.acknowledged() + acknowledged_datagrams_; }
    std::uint64_t sent_messages() const { return sent_messages_; }
    std::uint64_t sent_bytes() const { return sent_bytes_; }
    std::uint64_t dropped() const { return dropped_; }  // messages of Delivery::newest

  private:
    friend struct QuicCallbacks;
    QuicConnection(const TlsCredentials& credentials, bool is_server,
                   QuicConnectionSettings settings);
    bool begin(int result);
    bool is_new(std::optional<std::uint64_t> nonce) {
        if (!nonce || std::ranges::find(nonces_, *nonce) != nonces_.end()) {
            return false;
        }
        nonces_[next_nonce_] = *nonce;
        next_nonce_ = (next_nonce_ + 1) % nonces_.size();
        return true;
    }
    void open_stream();
    void fail(UdpSocket& socket, int error);
    void send_close(UdpSocket& socket, const ngtcp2_connection_close_error& error);
    std::string text_of_error(int error) const;
    // Nothing but acknowledgements and timers: these ride on the next tick's packet.
    bool is_idle() const { return is_open_ && queued_bytes() == 0; }
    ngtcp2_ssize write_packet(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                              ngtcp2_tstamp now);
    ngtcp2_ssize write_newest(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                              ngtcp2_tstamp now);
    ngtcp2_ssize write_stream(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                              ngtcp2_tstamp now);

    QuicConnectionSettings settings_;
    ngtcp2_conn* connection_ = nullptr;
    TlsSession tls_;
    UdpPlace own_;
    UdpPlace peer_;
    UdpPlace proven_peer_;
    std::deque<std::vector<std::uint8_t>> newest_;
    std::size_t newest_bytes_ = 0;
    StreamWriter stream_;
    std::int64_t stream_id_ = -1;
    bool is_blocked_ = false;  // true: flow control stops the stream until a packet comes
    StreamReader incoming_;
    std::vector<std::vector<std::byte>> taken_;  // messages of the packet that is read
    bool has_bad_message_ = false;
    bool is_open_ = false;
    bool has_valid_address_ = false;
    QuicEnd end_ = QuicEnd::none;
    std::string why_;
    std::uint64_t sent_messages_ = 0;
    std::uint64_t sent_bytes_ = 0;
    std::uint64_t dropped_ = 0;
    std::uint64_t acknowledged_datagrams_ = 0;
    // Of authentic packets. Copies of much older ones do not decrypt: a packet has only the end of
    // its number, which then stands for another number.
    std::array<std::uint64_t, 256> nonces_{};
    std::size_t next_nonce_ = 0;
    ngtcp2_tstamp wrote_ = 0;  // when a packet was sent last
};

}  // namespace handhold
