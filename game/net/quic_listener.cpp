// A server's end of QUIC connections, by ngtcp2.
#include <algorithm>
#include <exception>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "game/net/host_port.hpp"
#include "game/net/quic_arrivals.hpp"
#include "game/net/quic_connection.hpp"
#include "game/net/receive_budget.hpp"
#include "game/net/transport_kinds.hpp"

namespace handhold {
namespace {

constexpr int k_listener_buffer_bytes = 1 << 22;
// Headers of IP and UDP.
std::size_t headers_bytes(const UdpPlace& from) { return from.family() == AF_INET6 ? 48 : 28; }
// Datagrams in a peer's name may come at so many times the rate that the peer itself may use: so
// much from the peer's address, and so much again from all others.
constexpr double k_forged_share = 10.0;

LinkBudget budget_of_forged(LinkBudget budget) {
    budget.messages_per_s *= k_forged_share;
    budget.bytes_per_s *= k_forged_share;
    return budget;
}

double quic_now_s() { return static_cast<double>(quic_now()) / NGTCP2_SECONDS; }

struct QuicPeer {
    std::unique_ptr<QuicConnection> connection;
    ReceiveBudget budget;  // bytes and messages that are certainly the peer's
    // With the peer's proven address. Beyond it the peer loses datagrams too.
    ForgedGate forged_here;
    // With another address. Beyond it only such datagrams are lost, so the peer cannot move.
    ForgedGate forged_elsewhere;
    std::string address;
    bool is_opened = false;  // the handler knows of it
    bool is_read = true;     // false: over its budget
    int throttles = 0;
    double throttled_s = 0.0;  // the last time
    std::uint64_t acknowledged = 0;
    double advanced_s = 0.0;      // when that last grew, or nothing was queued
    double close_before_s = 0.0;  // 0: stays open
    LinkEnd end = LinkEnd::closed;
    bool is_ended = false;
    std::uint64_t counted_messages = 0;  // parts of the connection's sums that are in the counts
    std::uint64_t counted_bytes = 0;
    std::uint64_t counted_dropped = 0;
};

class QuicListener final : public DatagramListener {
  public:
    QuicListener(const ListenerSettings& settings, const UdpPlace& place,
                 std::unique_ptr<TlsCredentials> credentials)
        : settings_(settings),
          credentials_(std::move(credentials)),
          socket_(place, k_listener_buffer_bytes, UdpSocket::Side::server),
          own_(socket_.is_valid() ? socket_.place() : place),
          arrivals_(socket_, own_) {}
    ~QuicListener() override {
        for (auto& [link, peer] : links_) {
            peer.connection->close(socket_);
        }
    }

    bool is_valid() const { return socket_.is_valid(); }
    int port() const override { return own_.port(); }
    int descriptor() const override { return socket_.descriptor(); }
    std::vector<std::string> urls() const override {
        return {"quic://" + HostPort{settings_.address, port()}.text() + "#" +
                credentials_->fingerprint()};
    }

    double due_in_s() const override {
        ngtcp2_tstamp due = UINT64_MAX;
        for (const auto& [link, peer] : links_) {
            due = std::min(due, peer.connection->due());
        }
        const ngtcp2_tstamp now = quic_now();
        return due > now ? static_cast<double>(due - now) / NGTCP2_SECONDS : 0.0;
    }

    void poll(double wait_s, ListenerHandler& handler) override {
        write_all();
        if (wait_s > 0.0) {
            socket_.wait(std::min(wait_s, due_in_s()));
        }
        read_all(handler);
        tend_links();
        write_all();
        forget_ended(handler);
        counts_.overflowed_datagrams = socket_.overflowed_datagrams();
    }

    void send(LinkId link, Delivery delivery, std::span<const std::byte> message) override {
        const auto found = links_.find(link);
        if (found == links_.end() || found->second.close_before_s > 0.0) {
            return;
        }
        QuicPeer& peer = found->second;
        if (!peer.connection->push(delivery, message)) {
            end(peer, LinkEnd::slow);
            return;
        }
        counts_.most_queued_bytes =
            std::max(counts_.most_queued_bytes, peer.connection->queued_bytes());
    }

    std::size_t queued_bytes(LinkId link) const override {
        const auto found = links_.find(link);
        return found != links_.end() ? found->second.connection->queued_bytes() : 0;
    }

    void close(LinkId link) override {
        const auto found = links_.find(link);
        if (found != links_.end() && found->second.close_before_s == 0.0) {
            found->second.close_before_s = quic_now_s() + k_close_within_s;
        }
    }

    const ListenerCounts& counts() const override { return counts_; }

  private:
    void write_all() {
        for (auto& [link, peer] : links_) {
            peer.connection->write(socket_);
            count(peer);
        }
        counts_.sent_datagrams = socket_.sent_datagrams();
        counts_.sent_datagram_bytes = socket_.sent_bytes();
    }

    void count(QuicPeer& peer) {
        const QuicConnection& now = *peer.connection;
        counts_.sent_messages += now.sent_messages() - peer.counted_messages;
        counts_.sent_bytes += now.sent_bytes() - peer.counted_bytes;
        counts_.dropped += now.dropped() - peer.counted_dropped;
        peer.counted_messages = now.sent_messages();
        peer.counted_bytes = now.sent_bytes();
        peer.counted_dropped = now.dropped();
    }

    void read_all(ListenerHandler& handler) {
        constexpr int k_most_datagrams = 4096;  // the rest waits for the next poll
        arrivals_.begin_poll();
        for (int i = 0; i < k_most_datagrams; ++i) {
            UdpPlace from;
            std::span<const std::uint8_t> bytes;
            const UdpSocket::Read result = socket_.receive(from, bytes);
            if (result == UdpSocket::Read::nothing) {
                return;
            }
            if (result == UdpSocket::Read::datagram) {
                ++counts_.received_datagrams;
                counts_.received_datagram_bytes += bytes.size();
                take_datagram(from, bytes, handler);
            }
        }
    }

    void take_datagram(const UdpPlace& from, std::span<const std::uint8_t> bytes,
                       ListenerHandler& handler) {
        LinkId link = 0;
        try {
            const std::string id = arrivals_.id_of(from, bytes);
            const auto found = ids_.find(id);
            if (found != ids_.end()) {
                link = found->second;
            } else if (!id.empty()) {
                link = admit(from, bytes);
            }
            if (link == 0) {
                ++counts_.stray_datagrams;
                return;
            }
            read(link, from, bytes, handler);
        } catch (const std::exception& error) {
            ++counts_.failed;
            handler.failed(link, error.what());
            if (const auto failed = links_.find(link); failed != links_.end()) {
                end(failed->second, LinkEnd::closed);
            }
        }
    }

    // 0: the datagram begins no connection.
    LinkId admit(const UdpPlace& from, std::span<const std::uint8_t> bytes) {
        const std::string address = counted_address(from.text());
        const auto is_half_open = [](const auto& one) {
            return !one.second.connection->has_valid_address();
        };
        const auto half_open =
            static_cast<std::size_t>(std::ranges::count_if(links_, is_half_open));
        std::optional<QuicArrival> arrival = arrivals_.admit(from, bytes, half_open);
        counts_.retries = arrivals_.retries();
        if (!arrival) {
            return 0;
        }
        const auto same = std::ranges::count(
            links_, address,
            [](const auto& one) -> const std::string& { return one.second.address; });
        if (links_.size() >= settings_.most_links ||
            static_cast<std::size_t>(same) >= settings_.most_of_address) {
            ++counts_.refused;
            arrivals_.refuse(*arrival);
            return 0;
        }
        const LinkId link = ++last_link_;
        QuicConnectionSettings settings;
        settings.most_message_bytes = settings_.most_message_bytes;
        settings.connect_within_s = 5.0;
        settings.secret = &arrivals_.secret();
        settings.id_changed = [this, link](std::span<const std::uint8_t> id, bool belongs) {
            const std::string key(id.begin(), id.end());
            if (belongs) {
                ids_[key] = link;
            } else {
                ids_.erase(key);
            }
        };
        std::unique_ptr<QuicConnection> connection =
            QuicConnection::accept(*credentials_, *arrival, std::move(settings));
        if (connection == nullptr) {
            return 0;
        }
        const ReceiveBudget forged(budget_of_forged(settings_.budget));
        links_.emplace(link, QuicPeer{.connection = std::move(connection),
                                      .budget = ReceiveBudget(settings_.budget),
                                      .forged_here = {forged},
                                      .forged_elsewhere = {forged},
                                      .address = address,
                                      .advanced_s = quic_now_s()});
        return link;
    }

    void read(LinkId link, const UdpPlace& from, std::span<const std::uint8_t> bytes,
              ListenerHandler& handler) {
        QuicPeer& peer = links_.at(link);
        const bool is_from_peer = from == peer.connection->proven_peer();
        if (peer.is_ended || !may_read(peer, is_from_peer)) {
            return;
        }
        const auto take = [&](std::span<const std::byte> message) {
            open_if_due(link, peer, handler);
            ++counts_.received_messages;
            counts_.received_bytes += message.size();
            charge(peer, 1, 0);
            if (peer.close_before_s == 0.0 && !peer.is_ended) {
                handler.received(link, message);
            }
        };
        const std::size_t size = bytes.size() + headers_bytes(from);
        if (peer.connection->read(socket_, from, bytes, take)) {
            charge(peer, 0, size);
        } else {
            forged_gate(peer, is_from_peer).take(size, quic_now_s());
        }
        open_if_due(link, peer, handler);
        if (peer.connection->end() == QuicEnd::message) {
            end(peer, LinkEnd::message);
        } else if (!peer.is_opened) {
            peer.connection->write(socket_);  // the handshake goes on
        }
    }

    void open_if_due(LinkId link, QuicPeer& peer, ListenerHandler& handler) {
        if (!peer.is_opened && peer.connection->is_open()) {
            peer.is_opened = true;
            ++counts_.opened;
            handler.opened(link, peer.address);
        }
    }

    static ForgedGate& forged_gate(QuicPeer& peer, bool is_from_peer) {
        return is_from_peer ? peer.forged_here : peer.forged_elsewhere;
    }

    // False: the connection is over its budget. The datagram is not read, so it is lost.
    bool may_read(QuicPeer& peer, bool is_from_peer) {
        const double now_s = quic_now_s();
        peer.is_read = peer.is_read || peer.budget.may_read(now_s);
        if (peer.is_read && forged_gate(peer, is_from_peer).may_read(now_s)) {
            return true;
        }
        ++(is_from_peer ? counts_.unread_datagrams : counts_.unread_elsewhere);
        return false;
    }

    void charge(QuicPeer& peer, std::size_t messages, std::size_t bytes) {
        const double now_s = quic_now_s();
        if (peer.budget.take(messages, bytes, now_s) || !peer.is_read) {
            return;
        }
        ++counts_.throttled;
        peer.throttles = now_s - peer.throttled_s > k_calm_s ? 1 : peer.throttles + 1;
        peer.throttled_s = now_s;
        peer.is_read = false;
        if (peer.throttles > k_most_throttles) {
            end(peer, LinkEnd::flooding);
        }
    }

    // Ends a connection that misbehaves, without waiting for its queue.
    void end(QuicPeer& peer, LinkEnd why) {
        if (peer.is_ended) {
            return;
        }
        peer.is_ended = true;
        peer.end = why;
        counts_.bad_messages += why == LinkEnd::message ? 1U : 0U;
        counts_.ended_flooding += why == LinkEnd::flooding ? 1U : 0U;
        counts_.ended_slow += why == LinkEnd::slow ? 1U : 0U;
        peer.connection->close(socket_);
    }

    void tend_links() {
        const double now_s = quic_now_s();
        for (auto& [link, peer] : links_) {
            const QuicConnection& connection = *peer.connection;
            if (connection.acknowledged() != peer.acknowledged || connection.is_all_delivered()) {
                peer.acknowledged = connection.acknowledged();
                peer.advanced_s = now_s;
            } else if (now_s - peer.advanced_s > settings_.slow_after_s) {
                end(peer, LinkEnd::slow);
            }
            if (peer.close_before_s > 0.0 &&
                (connection.is_all_delivered() || now_s > peer.close_before_s)) {
                end(peer, LinkEnd::closed);
            }
        }
    }

    void forget_ended(ListenerHandler& handler) {
        for (auto at = links_.begin(); at != links_.end();) {
            if (!at->second.is_ended && at->second.connection->end() == QuicEnd::none) {
                ++at;
                continue;
            }
            const LinkId link = at->first;
            const LinkEnd why = at->second.end;
            const bool was_opened = at->second.is_opened;
            count(at->second);
            at = links_.erase(at);
            std::erase_if(ids_, [link](const auto& one) { return one.second == link; });
            if (was_opened) {
                handler.closed(link, why);
            }
        }
    }

    ListenerSettings settings_;
    std::unique_ptr<TlsCredentials> credentials_;
    UdpSocket socket_;
    UdpPlace own_;
    QuicArrivals arrivals_;
    std::map<LinkId, QuicPeer> links_;
    std::map<std::string, LinkId> ids_;  // connection IDs
    LinkId last_link_ = 0;
    ListenerCounts counts_;
};

}  // namespace

Result<std::unique_ptr<DatagramListener>> open_quic_listener(const ListenerSettings& settings) {
    const std::vector<UdpPlace> places = find_places(settings.address, settings.port);
    const FileError taken{HostPort{settings.address, settings.port}.text(), "",
                          "expected an address and a port that are free"};
    if (places.empty()) {
        return taken;
    }
    Result<std::unique_ptr<TlsCredentials>> credentials =
        TlsCredentials::of_server(settings.certificate, settings.key);
    if (!credentials) {
        return credentials.error();
    }
    auto listener =
        std::make_unique<QuicListener>(settings, places.front(), std::move(credentials.value()));
    if (!listener->is_valid()) {
        return taken;
    }
    return std::unique_ptr<DatagramListener>(std::move(listener));
}

bool has_quic() { return true; }

}  // namespace handhold
