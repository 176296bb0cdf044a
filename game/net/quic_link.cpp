// A peer's QUIC connection to a server, by ngtcp2.
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "game/net/host_port.hpp"
#include "game/net/net_messages.hpp"
#include "game/net/quic_connection.hpp"
#include "game/net/transport_kinds.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_most_from_server = StatePiece::k_most_bytes + 64;
constexpr std::uint64_t k_window_bytes = 512U << 10U;
constexpr int k_kernel_buffer_bytes = 1 << 18;

struct QuicUrl {
    HostPort place;
    Fingerprint fingerprint;
};

std::optional<QuicUrl> parse_quic_url(std::string_view url) {
    constexpr std::string_view k_scheme = "quic://";
    QuicUrl out;
    if (!url.starts_with(k_scheme)) {
        return std::nullopt;
    }
    url.remove_prefix(k_scheme.size());
    if (const std::size_t hash = url.find('#'); hash != std::string_view::npos) {
        out.fingerprint = read_fingerprint(url.substr(hash + 1));
        if (out.fingerprint.empty()) {
            return std::nullopt;
        }
        url = url.substr(0, hash);
    }
    std::optional<HostPort> place = read_host_port(url, 0);
    if (!place) {
        return std::nullopt;
    }
    out.place = std::move(*place);
    return out;
}

// Tokens of servers that this program has been connected to, by URL and address: with one a busy
// server needs no Retry to know this address.
class KnownServers {
  public:
    std::vector<std::uint8_t> take(const std::string& url) {
        const auto found = tokens_.find(url);
        return found != tokens_.end() ? std::exchange(found->second, {})
                                      : std::vector<std::uint8_t>();
    }
    void keep(const std::string& url, std::span<const std::uint8_t> token) {
        constexpr std::size_t k_most = 16;
        constexpr std::size_t k_most_bytes = 512;
        if (token.size() <= k_most_bytes && (tokens_.size() < k_most || tokens_.contains(url))) {
            tokens_[url].assign(token.begin(), token.end());
        }
    }

  private:
    std::map<std::string, std::vector<std::uint8_t>> tokens_;
};

KnownServers& known_servers() {
    static KnownServers known;
    return known;
}

class QuicLink final : public Link {
  public:
    // `servers`: the places that the host's name has, at least one. The first that answers is
    // taken.
    QuicLink(std::string text, const QuicUrl& url, std::vector<UdpPlace> servers)
        : url_(std::move(text)),
          credentials_(TlsCredentials::of_peer(url.place.host, url.fingerprint)),
          servers_(std::move(servers)) {
        connect_next();
    }
    ~QuicLink() override {
        if (connection_ != nullptr) {
            connection_->close(*socket_);
        }
    }

    void poll(double wait_s, LinkHandler& handler) override {
        if (connection_ != nullptr && connection_->end() == QuicEnd::none) {
            connection_->write(*socket_);
            wait(wait_s);
            read(handler);
            connection_->write(*socket_);
            end_if_due();
        }
        if (!has_heard_ && next_ < servers_.size() && closes_since_ == 0 && is_next_due()) {
            connect_next();
        }
        if (is_told_ || (connection_ != nullptr && connection_->end() == QuicEnd::none)) {
            return;
        }
        is_told_ = true;
        handler.closed(!why_.empty() ? why_ : connection_->why());
    }

    void send(Delivery delivery, std::span<const std::byte> message) override {
        if (connection_ == nullptr || closes_since_ > 0) {
            return;
        }
        if (!connection_->push(delivery, message)) {
            close();
        } else if (connection_->is_open()) {
            connection_->write(*socket_);
        }
    }

    std::size_t queued_bytes() const override {
        return connection_ != nullptr ? connection_->queued_bytes() : 0;
    }

    void close() override {
        if (closes_since_ == 0) {
            closes_since_ = quic_now();
        }
    }

  private:
    void connect_next() {
        QuicConnectionSettings settings;
        settings.most_message_bytes = k_most_from_server;
        settings.window_bytes = k_window_bytes;
        const UdpPlace& server = servers_[next_++];
        const std::string name = url_ + " " + server.text();
        settings.token_given = [name](std::span<const std::uint8_t> token) {
            known_servers().keep(name, token);
        };
        began_ = quic_now();
        why_.clear();
        if (connection_ != nullptr) {
            connection_->close(*socket_);
            connection_ = nullptr;
        }
        socket_ = std::make_unique<UdpSocket>(UdpPlace::any(server.family()), k_kernel_buffer_bytes,
                                              UdpSocket::Side::peer);
        if (socket_->is_valid()) {
            connection_ = QuicConnection::connect(*credentials_, socket_->place(), server,
                                                  known_servers().take(name), std::move(settings));
        }
        if (connection_ == nullptr) {
            why_ = "no connection can be made";
        }
    }
    // A place that refuses, or does not answer, leaves the turn to the next one.
    bool is_next_due() const {
        constexpr ngtcp2_duration k_answers_within = NGTCP2_SECONDS;
        return connection_ == nullptr || connection_->end() != QuicEnd::none ||
               quic_now() - began_ > k_answers_within;
    }

    void wait(double wait_s) const {
        const ngtcp2_tstamp due = connection_->due();
        const ngtcp2_tstamp now = quic_now();
        const double due_s = due > now ? static_cast<double>(due - now) / NGTCP2_SECONDS : 0.0;
        socket_->wait(std::min(wait_s, due_s));
    }

    void read(LinkHandler& handler) {
        constexpr int k_most_datagrams = 512;
        for (int i = 0; i < k_most_datagrams && connection_->end() == QuicEnd::none; ++i) {
            UdpPlace from;
            std::span<const std::uint8_t> bytes;
            const UdpSocket::Read result = socket_->receive(from, bytes);
            if (result == UdpSocket::Read::nothing) {
                return;
            }
            if (result == UdpSocket::Read::refused) {
                if (!has_heard_) {
                    why_ = "connection refused";
                    connection_->close(*socket_);
                }
                continue;
            }
            has_heard_ = has_heard_ || from == server_place();
            const bool was_open = connection_->is_open();
            connection_->read(
                *socket_, server_place(), bytes,
                [&handler](std::span<const std::byte> message) { handler.received(message); });
            if (!was_open && connection_->is_open()) {
                handler.opened();
            }
        }
    }
    // The server has one address, whatever a network on the way writes.
    UdpPlace server_place() const { return connection_->peer(); }

    void end_if_due() {
        if (closes_since_ > 0 &&
            (connection_->is_all_delivered() ||
             static_cast<double>(quic_now() - closes_since_) > k_close_within_s * NGTCP2_SECONDS)) {
            connection_->close(*socket_);
        }
    }

    std::string url_;
    std::unique_ptr<TlsCredentials> credentials_;
    std::vector<UdpPlace> servers_;
    std::size_t next_ = 0;  // the place that is next
    ngtcp2_tstamp began_ = 0;
    std::unique_ptr<UdpSocket> socket_;
    std::unique_ptr<QuicConnection> connection_;
    std::string why_;
    ngtcp2_tstamp closes_since_ = 0;  // 0: stays open
    bool has_heard_ = false;
    bool is_told_ = false;
};

}  // namespace

Result<std::unique_ptr<Link>> open_quic_link(const std::string& url) {
    const std::optional<QuicUrl> parsed = parse_quic_url(url);
    if (!parsed) {
        return FileError{url, "",
                         "expected quic://HOST:PORT, or quic://HOST:PORT#FINGERPRINT with 64 "
                         "hexadecimal digits"};
    }
    std::vector<UdpPlace> servers = find_places(parsed->place.host, parsed->place.port);
    if (servers.empty()) {
        return FileError{url, "", "no server: there is no such host"};
    }
    return std::unique_ptr<Link>(std::make_unique<QuicLink>(url, *parsed, std::move(servers)));
}

}  // namespace handhold
