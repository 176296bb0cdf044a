#include "game/net/quic_connection.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "game/net/quic_callbacks.hpp"
#include "game/net/send_queue.hpp"

namespace handhold {
namespace {

constexpr int k_most_packets_at_once = 32;
// On a fast network ngtcp2 acknowledges at once, which would double the number of packets.
constexpr ngtcp2_duration k_idle_between = 12 * NGTCP2_MILLISECONDS;

ngtcp2_path path_of(UdpPlace& own, UdpPlace& peer) {
    return {{own.data(), own.size()}, {peer.data(), peer.size()}, nullptr};
}

ngtcp2_settings make_settings(const QuicConnectionSettings& settings,
                              std::span<const std::uint8_t> token) {
    ngtcp2_settings out;
    ngtcp2_settings_default(&out);
    // Cubic and Reno take jitter for loss, and then hold datagrams up.
    out.cc_algo = NGTCP2_CC_ALGO_BBR2;
    out.initial_ts = quic_now();
    out.initial_rtt = 100 * NGTCP2_MILLISECONDS;  // a lost first packet is repeated after 0.3 s
    out.max_tx_udp_payload_size = k_datagram_bytes;
    // No probe is within the size above, so none is sent. With no_pmtud ngtcp2 0.12.1 fails an
    // assertion if a packet's copy comes from elsewhere before the packet itself.
    out.no_pmtud = 0;
    out.ack_thresh = 10;  // acknowledgements ride on the packet of the next tick
    out.handshake_timeout =
        static_cast<ngtcp2_duration>(settings.connect_within_s * NGTCP2_SECONDS);
    out.token = {const_cast<std::uint8_t*>(token.data()), token.size()};  // is copied
    return out;
}

ngtcp2_transport_params make_parameters(const QuicConnectionSettings& settings) {
    constexpr ngtcp2_duration k_silent = 10 * NGTCP2_SECONDS;
    ngtcp2_transport_params out;
    ngtcp2_transport_params_default(&out);
    out.initial_max_streams_uni = 1;
    out.initial_max_stream_data_uni = settings.window_bytes;
    out.initial_max_data = settings.window_bytes;
    out.max_idle_timeout = k_silent;
    out.max_udp_payload_size = 1500;
    out.max_datagram_frame_size = 1500;
    out.active_connection_id_limit = 4;
    return out;
}

ngtcp2_cid random_id(std::size_t size) {
    std::array<std::uint8_t, NGTCP2_MAX_CIDLEN> bytes{};
    (void)fill_randomly(bytes.data(), size);
    ngtcp2_cid out;
    ngtcp2_cid_init(&out, bytes.data(), size);
    return out;
}

}  // namespace

ngtcp2_tstamp quic_now() {
    return static_cast<ngtcp2_tstamp>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                          std::chrono::steady_clock::now().time_since_epoch())
                                          .count());
}

QuicConnection::QuicConnection(const TlsCredentials& credentials, bool is_server,
                               QuicConnectionSettings settings)
    : settings_(std::move(settings)), tls_(credentials, is_server, connection_) {}

QuicConnection::~QuicConnection() { ngtcp2_conn_del(connection_); }

bool QuicConnection::begin(int result) {
    if (result != 0) {
        return false;
    }
    ngtcp2_conn_set_tls_native_handle(connection_, tls_.get());
    return true;
}

std::unique_ptr<QuicConnection> QuicConnection::accept(const TlsCredentials& credentials,
                                                       const QuicArrival& arrival,
                                                       QuicConnectionSettings settings) {
    std::unique_ptr<QuicConnection> out(new QuicConnection(credentials, true, std::move(settings)));
    if (!out->tls_.is_valid()) {
        return nullptr;
    }
    out->own_ = arrival.own;
    out->peer_ = arrival.peer;
    out->proven_peer_ = arrival.peer;  // a connection does not move before it is open
    out->has_valid_address_ = arrival.has_token;
    const ngtcp2_pkt_hd& header = arrival.header;
    const ngtcp2_cid id = random_id(k_connection_id_bytes);
    ngtcp2_transport_params parameters = make_parameters(out->settings_);
    parameters.original_dcid = arrival.is_after_retry ? arrival.before_retry : header.dcid;
    parameters.retry_scid_present = arrival.is_after_retry ? 1 : 0;
    parameters.retry_scid = header.dcid;
    const QuicSecret& secret = *out->settings_.secret;
    parameters.stateless_reset_token_present =
        ngtcp2_crypto_generate_stateless_reset_token(parameters.stateless_reset_token,
                                                     secret.data(), secret.size(), &id) == 0
            ? 1
            : 0;
    const std::span<const std::uint8_t> token =
        arrival.has_token ? std::span<const std::uint8_t>(header.token.base, header.token.len)
                          : std::span<const std::uint8_t>();
    const ngtcp2_settings chosen = make_settings(out->settings_, token);
    const ngtcp2_path path = path_of(out->own_, out->peer_);
    const ngtcp2_callbacks callbacks = quic_callbacks(true);
    if (!out->begin(ngtcp2_conn_server_new(&out->connection_, &header.scid, &id, &path,
                                           header.version, &callbacks, &chosen, &parameters,
                                           nullptr, out.get()))) {
        return nullptr;
    }
    out->settings_.id_changed({header.dcid.data, header.dcid.datalen}, true);
    out->settings_.id_changed({id.data, id.datalen}, true);
    return out;
}

std::unique_ptr<QuicConnection> QuicConnection::connect(const TlsCredentials& credentials,
                                                        const UdpPlace& own, const UdpPlace& server,
                                                        std::span<const std::uint8_t> token,
                                                        QuicConnectionSettings settings) {
    constexpr ngtcp2_duration k_keep_alive = 3 * NGTCP2_SECONDS;
    std::unique_ptr<QuicConnection> out(
        new QuicConnection(credentials, false, std::move(settings)));
    if (!out->tls_.is_valid()) {
        return nullptr;
    }
    out->own_ = own;
    out->peer_ = server;
    out->proven_peer_ = server;
    out->has_valid_address_ = true;
    const ngtcp2_cid to = random_id(NGTCP2_MIN_INITIAL_DCIDLEN);
    const ngtcp2_cid from = random_id(0);
    const ngtcp2_transport_params parameters = make_parameters(out->settings_);
    const ngtcp2_settings chosen = make_settings(out->settings_, token);
    const ngtcp2_path path = path_of(out->own_, out->peer_);
    const ngtcp2_callbacks callbacks = quic_callbacks(false);
    if (!out->begin(ngtcp2_conn_client_new(&out->connection_, &to, &from, &path,
                                           NGTCP2_PROTO_VER_V1, &callbacks, &chosen, &parameters,
                                           nullptr, out.get()))) {
        return nullptr;
    }
    ngtcp2_conn_set_keep_alive_timeout(out->connection_, k_keep_alive);
    return out;
}

bool QuicConnection::read(UdpSocket& socket, const UdpPlace& from,
                          std::span<const std::uint8_t> datagram, const Take& take) {
    if (end_ != QuicEnd::none || datagram.empty()) {
        return false;
    }
    UdpPlace peer = from;
    const ngtcp2_path path = path_of(own_, peer);
    is_blocked_ = false;
    (void)take_authentic_nonce();
    const int result = ngtcp2_conn_read_pkt(connection_, &path, nullptr, datagram.data(),
                                            datagram.size(), quic_now());
    const bool is_authentic = is_new(take_authentic_nonce());
    const std::vector<std::vector<std::byte>> taken = std::exchange(taken_, {});
    if (result == 0) {
        open_stream();
    } else {
        fail(socket, result);
    }
    for (const std::vector<std::byte>& message : taken) {
        take(message);
    }
    return is_authentic;
}

void QuicConnection::open_stream() {
    if (is_open_ && stream_id_ < 0 &&
        ngtcp2_conn_open_uni_stream(connection_, &stream_id_, nullptr) != 0) {
        stream_id_ = -1;  // the other side has not allowed it yet
    }
}

bool QuicConnection::push(Delivery delivery, std::span<const std::byte> message) {
    if (end_ != QuicEnd::none) {
        return true;
    }
    if (delivery == Delivery::newest && message.size() <= k_most_in_datagram) {
        if (newest_.size() >= SendQueue::k_most_newest) {
            newest_bytes_ -= newest_.front().size();
            newest_.pop_front();
            ++dropped_;
        }
        newest_bytes_ += message.size();
        std::vector<std::uint8_t>& kept = newest_.emplace_back(message.size());
        std::ranges::transform(message, kept.begin(),
                               [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
        return true;
    }
    if (stream_.push(message)) {
        ++sent_messages_;
        sent_bytes_ += message.size();
        return true;
    }
    dropped_ += delivery == Delivery::newest ? 1U : 0U;
    return delivery == Delivery::newest;
}

// Returns NGTCP2_ERR_WRITE_MORE where the packet has room for more, as the functions of ngtcp2.
ngtcp2_ssize QuicConnection::write_newest(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                                          ngtcp2_tstamp now) {
    std::vector<std::uint8_t>& message = newest_.front();
    const ngtcp2_vec data{message.data(), message.size()};
    int is_taken = 0;
    const ngtcp2_ssize size =
        ngtcp2_conn_writev_datagram(connection_, &path.path, nullptr, packet.data(), packet.size(),
                                    &is_taken, NGTCP2_WRITE_DATAGRAM_FLAG_MORE, 0, &data, 1, now);
    if (is_taken != 0) {
        ++sent_messages_;
        sent_bytes_ += message.size();
        newest_bytes_ -= message.size();
        newest_.pop_front();
    }
    return size;
}

ngtcp2_ssize QuicConnection::write_stream(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                                          ngtcp2_tstamp now) {
    const std::span<const std::uint8_t> bytes = stream_.next();
    const ngtcp2_vec data{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
    ngtcp2_ssize taken = -1;
    ngtcp2_ssize size =
        ngtcp2_conn_writev_stream(connection_, &path.path, nullptr, packet.data(), packet.size(),
                                  &taken, NGTCP2_WRITE_STREAM_FLAG_MORE, stream_id_, &data, 1, now);
    if (taken > 0) {
        stream_.mark_sent(static_cast<std::size_t>(taken));
    }
    if (size == NGTCP2_ERR_STREAM_DATA_BLOCKED) {
        is_blocked_ = true;
        size = NGTCP2_ERR_WRITE_MORE;
    }
    return size;
}

ngtcp2_ssize QuicConnection::write_packet(std::span<std::uint8_t> packet, ngtcp2_path_storage& path,
                                          ngtcp2_tstamp now) {
    while (is_open_ && !newest_.empty()) {
        const ngtcp2_ssize size = write_newest(packet, path, now);
        if (size != NGTCP2_ERR_WRITE_MORE) {
            return size;
        }
    }
    while (stream_id_ >= 0 && !is_blocked_ && !stream_.next().empty()) {
        const ngtcp2_ssize size = write_stream(packet, path, now);
        if (size != NGTCP2_ERR_WRITE_MORE) {
            return size;
        }
    }
    return ngtcp2_conn_writev_stream(connection_, &path.path, nullptr, packet.data(), packet.size(),
                                     nullptr, NGTCP2_WRITE_STREAM_FLAG_NONE, -1, nullptr, 0, now);
}

void QuicConnection::write(UdpSocket& socket) {
    if (end_ != QuicEnd::none) {
        return;
    }
    const ngtcp2_tstamp now = quic_now();
    if (is_idle() && now < wrote_ + k_idle_between) {
        return;
    }
    if (ngtcp2_conn_get_expiry(connection_) <= now) {
        if (const int result = ngtcp2_conn_handle_expiry(connection_, now); result != 0) {
            fail(socket, result);
            return;
        }
    }
    std::array<std::uint8_t, k_datagram_bytes> packet{};
    ngtcp2_path_storage path;
    ngtcp2_path_storage_zero(&path);
    bool is_any = false;
    for (int i = 0; i < k_most_packets_at_once; ++i) {
        const ngtcp2_ssize size = write_packet(packet, path, now);
        if (size < 0) {
            fail(socket, static_cast<int>(size));
            return;
        }
        if (size == 0) {
            break;
        }
        is_any = true;
        socket.send(UdpPlace(path.path.remote.addr),
                    std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
    }
    if (is_any) {
        wrote_ = now;
        ngtcp2_conn_update_pkt_tx_time(connection_, now);
    }
}

ngtcp2_tstamp QuicConnection::due() const {
    if (end_ != QuicEnd::none) {
        return UINT64_MAX;
    }
    const ngtcp2_tstamp expiry = ngtcp2_conn_get_expiry(connection_);
    return is_idle() ? std::max(expiry, wrote_ + k_idle_between) : expiry;
}

UdpPlace QuicConnection::peer() const {
    return UdpPlace(ngtcp2_conn_get_path(connection_)->remote.addr);
}

void QuicConnection::send_close(UdpSocket& socket, const ngtcp2_connection_close_error& error) {
    std::array<std::uint8_t, k_datagram_bytes> packet{};
    ngtcp2_path_storage path;
    ngtcp2_path_storage_zero(&path);
    const ngtcp2_ssize size = ngtcp2_conn_write_connection_close(
        connection_, &path.path, nullptr, packet.data(), packet.size(), &error, quic_now());
    if (size > 0) {
        socket.send(UdpPlace(path.path.remote.addr),
                    std::span<const std::uint8_t>(packet).first(static_cast<std::size_t>(size)));
    }
}

void QuicConnection::close(UdpSocket& socket, std::uint64_t code) {
    if (end_ != QuicEnd::none) {
        return;
    }
    ngtcp2_connection_close_error error;
    ngtcp2_connection_close_error_default(&error);
    if (code != 0) {
        ngtcp2_connection_close_error_set_transport_error(&error, code, nullptr, 0);
    } else {
        ngtcp2_connection_close_error_set_application_error(&error, 0, nullptr, 0);
    }
    send_close(socket, error);
    end_ = QuicEnd::closed;
    why_ = "closed";
}

std::string QuicConnection::text_of_error(int error) const {
    if (tls_.is_untrusted()) {
        return tls_.has_fingerprint()
                   ? "the server's certificate has another fingerprint"
                   : "the server's certificate is not known here: join by the whole address that "
                     "the server prints, quic://HOST:PORT#FINGERPRINT";
    }
    switch (error) {
        case NGTCP2_ERR_HANDSHAKE_TIMEOUT:
            return "no answer";
        case NGTCP2_ERR_IDLE_CLOSE:
            return "nothing was heard for long";
        case NGTCP2_ERR_RECV_VERSION_NEGOTIATION:
            return "other version of QUIC";
        case NGTCP2_ERR_CRYPTO:
            return std::string("TLS: ") +
                   TlsSession::text_of_alert(ngtcp2_conn_get_tls_alert(connection_));
        case NGTCP2_ERR_DRAINING: {
            ngtcp2_connection_close_error told;
            ngtcp2_conn_get_connection_close_error(connection_, &told);
            const bool is_refused =
                told.type == NGTCP2_CONNECTION_CLOSE_ERROR_CODE_TYPE_TRANSPORT &&
                told.error_code == NGTCP2_CONNECTION_REFUSED;
            return is_refused ? "the server takes no more connections"
                              : "the connection was closed";
        }
        default:
            return std::string("QUIC: ") + ngtcp2_strerror(error);
    }
}

void QuicConnection::fail(UdpSocket& socket, int error) {
    why_ = text_of_error(error);
    if (error == NGTCP2_ERR_DROP_CONN || error == NGTCP2_ERR_RETRY) {
        end_ = QuicEnd::dropped;
        return;
    }
    end_ = has_bad_message_ ? QuicEnd::message : QuicEnd::closed;
    if (error == NGTCP2_ERR_DRAINING || error == NGTCP2_ERR_IDLE_CLOSE ||
        error == NGTCP2_ERR_HANDSHAKE_TIMEOUT) {
        return;  // there is nobody to tell
    }
    ngtcp2_connection_close_error told;
    ngtcp2_connection_close_error_default(&told);
    if (error == NGTCP2_ERR_CRYPTO) {
        ngtcp2_connection_close_error_set_transport_error_tls_alert(
            &told, ngtcp2_conn_get_tls_alert(connection_), nullptr, 0);
    } else {
        ngtcp2_connection_close_error_set_transport_error_liberr(&told, error, nullptr, 0);
    }
    send_close(socket, told);
}

}  // namespace handhold
