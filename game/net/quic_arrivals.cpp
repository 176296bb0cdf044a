#include "game/net/quic_arrivals.hpp"

#include <array>
#include <stdexcept>

#include <ngtcp2/ngtcp2_crypto.h>

#include "game/net/host_port.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_least_initial_bytes = 1200;
constexpr ngtcp2_duration k_retry_within = 10 * NGTCP2_SECONDS;
constexpr ngtcp2_duration k_token_within = 3600 * NGTCP2_SECONDS;
// A handshake costs about a millisecond of the processor.
constexpr JoinRate k_strangers{16.0, 32.0};
constexpr JoinRate k_handshakes{64.0, 128.0};
constexpr JoinRate k_handshakes_of_address{8.0, 48.0};

ngtcp2_version_cid read_ids(std::span<const std::uint8_t> datagram, int& result) {
    ngtcp2_version_cid out{};
    result = ngtcp2_pkt_decode_version_cid(&out, datagram.data(), datagram.size(),
                                           k_connection_id_bytes);
    return out;
}

}  // namespace

QuicArrivals::QuicArrivals(UdpSocket& socket, const UdpPlace& own)
    : socket_(socket),
      own_(own),
      of_strangers_(k_strangers, k_strangers),
      of_addresses_(k_handshakes, k_handshakes_of_address) {
    if (!fill_randomly(secret_.data(), secret_.size())) {
        throw std::runtime_error("this system gives no random numbers");
    }
}

void QuicArrivals::begin_poll() {
    const double now_s = static_cast<double>(quic_now()) / NGTCP2_SECONDS;
    const double elapsed_s = refilled_s_ > 0.0 ? now_s - refilled_s_ : 0.0;
    of_strangers_.refill(elapsed_s);
    of_addresses_.refill(elapsed_s);
    refilled_s_ = now_s;
    answers_ = 0;
    begun_ = 0;
}

bool QuicArrivals::may_answer() { return ++answers_ <= k_most_answers; }

std::string QuicArrivals::id_of(const UdpPlace& from, std::span<const std::uint8_t> datagram) {
    if (datagram.empty()) {
        return {};  // ngtcp2 ends the program
    }
    int result = 0;
    const ngtcp2_version_cid ids = read_ids(datagram, result);
    if (result == 0) {
        return {ids.dcid, ids.dcid + ids.dcidlen};
    }
    if (result == NGTCP2_ERR_VERSION_NEGOTIATION && datagram.size() >= k_least_initial_bytes &&
        may_answer()) {
        std::array<std::uint8_t, 256> packet{};
        const std::uint32_t spoken = NGTCP2_PROTO_VER_V1;
        const ngtcp2_ssize size =
            ngtcp2_pkt_write_version_negotiation(packet.data(), packet.size(), 0, ids.scid,
                                                 ids.scidlen, ids.dcid, ids.dcidlen, &spoken, 1);
        if (size > 0) {
            socket_.send(
                from, std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
        }
    }
    return {};
}

std::optional<QuicArrival> QuicArrivals::admit(const UdpPlace& from,
                                               std::span<const std::uint8_t> datagram,
                                               std::size_t half_open) {
    constexpr std::uint8_t k_long_header = 0x80;
    if (datagram.size() < k_least_initial_bytes) {
        if (!datagram.empty() && (datagram[0] & k_long_header) == 0) {
            send_reset(from, datagram);
        }
        return std::nullopt;
    }
    QuicArrival arrival;
    arrival.own = own_;
    arrival.peer = from;
    if (const int result = ngtcp2_accept(&arrival.header, datagram.data(), datagram.size());
        result != 0 && result != NGTCP2_ERR_RETRY) {
        return std::nullopt;
    }
    if (arrival.header.version != NGTCP2_PROTO_VER_V1 || !check_token(arrival)) {
        return std::nullopt;
    }
    const bool has_room = begun_ < k_most_begun;
    if (arrival.has_token) {
        if (!has_room || !of_addresses_.take(counted_address(from.text()))) {
            return std::nullopt;
        }
    } else if (!has_room || half_open >= k_most_half_open || !of_strangers_.take("")) {
        send_retry(arrival);
        return std::nullopt;
    }
    ++begun_;
    return arrival;
}

// False: an answer to a Retry that is none. A token of another kind that is bad is no token.
bool QuicArrivals::check_token(QuicArrival& arrival) const {
    const ngtcp2_vec& token = arrival.header.token;
    if (token.len == 0) {
        return true;
    }
    if (token.base[0] != NGTCP2_CRYPTO_TOKEN_MAGIC_RETRY) {
        arrival.has_token =
            ngtcp2_crypto_verify_regular_token(
                token.base, token.len, secret_.data(), secret_.size(), arrival.peer.data(),
                arrival.peer.size(), k_token_within, quic_now()) == 0;
        return true;
    }
    arrival.has_token =
        ngtcp2_crypto_verify_retry_token(&arrival.before_retry, token.base, token.len,
                                         secret_.data(), secret_.size(), arrival.header.version,
                                         arrival.peer.data(), arrival.peer.size(),
                                         &arrival.header.dcid, k_retry_within, quic_now()) == 0;
    arrival.is_after_retry = arrival.has_token;
    return arrival.has_token;
}

void QuicArrivals::send_retry(const QuicArrival& arrival) {
    if (!may_answer()) {
        return;
    }
    ngtcp2_cid id;
    std::array<std::uint8_t, k_connection_id_bytes> bytes{};
    if (!fill_randomly(bytes.data(), bytes.size())) {
        return;
    }
    ngtcp2_cid_init(&id, bytes.data(), bytes.size());
    std::array<std::uint8_t, NGTCP2_CRYPTO_MAX_RETRY_TOKENLEN> token{};
    const ngtcp2_ssize token_size = ngtcp2_crypto_generate_retry_token(
        token.data(), secret_.data(), secret_.size(), arrival.header.version, arrival.peer.data(),
        arrival.peer.size(), &id, &arrival.header.dcid, quic_now());
    if (token_size < 0) {
        return;
    }
    std::array<std::uint8_t, 512> packet{};
    const ngtcp2_ssize size = ngtcp2_crypto_write_retry(
        packet.data(), packet.size(), arrival.header.version, &arrival.header.scid, &id,
        &arrival.header.dcid, token.data(), static_cast<std::size_t>(token_size));
    if (size > 0) {
        ++retries_;
        socket_.send(arrival.peer,
                     std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
    }
}

// A peer whose connection is forgotten here learns that it has ended.
void QuicArrivals::send_reset(const UdpPlace& to, std::span<const std::uint8_t> datagram) {
    int result = 0;
    const ngtcp2_version_cid ids = read_ids(datagram, result);
    if (result != 0 ||
        datagram.size() <= NGTCP2_MIN_STATELESS_RESET_RANDLEN + NGTCP2_STATELESS_RESET_TOKENLEN ||
        !may_answer()) {
        return;
    }
    ngtcp2_cid id;
    ngtcp2_cid_init(&id, ids.dcid, ids.dcidlen);
    std::array<std::uint8_t, NGTCP2_STATELESS_RESET_TOKENLEN> token{};
    std::array<std::uint8_t, NGTCP2_MIN_STATELESS_RESET_RANDLEN> noise{};
    std::array<std::uint8_t, 64> packet{};
    if (ngtcp2_crypto_generate_stateless_reset_token(token.data(), secret_.data(), secret_.size(),
                                                     &id) != 0 ||
        !fill_randomly(noise.data(), noise.size())) {
        return;
    }
    const ngtcp2_ssize size = ngtcp2_pkt_write_stateless_reset(
        packet.data(), packet.size(), token.data(), noise.data(), noise.size());
    if (size > 0) {
        socket_.send(to,
                     std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
    }
}

void QuicArrivals::refuse(const QuicArrival& arrival) {
    if (!may_answer()) {
        return;
    }
    std::array<std::uint8_t, 256> packet{};
    const ngtcp2_ssize size = ngtcp2_crypto_write_connection_close(
        packet.data(), packet.size(), arrival.header.version, &arrival.header.scid,
        &arrival.header.dcid, NGTCP2_CONNECTION_REFUSED, nullptr, 0);
    if (size > 0) {
        socket_.send(arrival.peer,
                     std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
    }
}

}  // namespace handhold
