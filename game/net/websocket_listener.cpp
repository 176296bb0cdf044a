// A server's end of WebSocket connections, by libwebsockets.
#include <algorithm>
#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/socket.h>
#include <unistd.h>

#include "game/net/host_port.hpp"
#include "game/net/receive_budget.hpp"
#include "game/net/send_queue.hpp"
#include "game/net/transport_kinds.hpp"
#include "game/net/websocket_context.hpp"
#include "game/net/websocket_socket.hpp"

namespace handhold {
namespace {

constexpr double k_look_s = 0.02;

struct WebSocketPeer {
    lws* wsi = nullptr;
    SendQueue queue;
    ReceiveBudget budget;
    std::vector<std::byte> incoming;  // a message that is not complete
    bool is_read = true;              // false: over its budget
    std::uint64_t counted_bytes = 0;  // part of bytes_read_from that the budget has
    double looked_s = 0.0;            // when these were last compared
    int throttles = 0;
    double throttled_s = 0.0;     // the last time
    double waits_since_s = 0.0;   // since when the queue's first message waits
    double close_before_s = 0.0;  // 0: stays open
    LinkEnd end = LinkEnd::closed;
    std::vector<unsigned char> outgoing;  // room for libwebsockets' header, and a message
};

// libwebsockets keeps one of these for each connection.
struct WebSocketSession {
    LinkId link;  // 0: not a WebSocket
};

class WebSocketListener final : public Listener {
  public:
    WebSocketListener(const ListenerSettings& settings, int descriptor)
        : settings_(settings), protocols_(protocols()), context_(info()) {
        is_valid_ = context_.get() != nullptr && (descriptor < 0 || wake_by(descriptor));
    }

    bool is_valid() const { return is_valid_; }
    int port() const override {
        return lws_get_vhost_listen_port(lws_get_vhost_by_name(context_.get(), "default"));
    }
    std::vector<std::string> urls() const override {
        return {"ws://" + HostPort{settings_.address, port()}.text()};
    }

    void poll(double wait_s, ListenerHandler& handler) override {
        handler_ = &handler;
        context_.service(wait_s);
        tend_links();  // Later than service, which takes what came while nobody polled.
        handler_ = nullptr;
    }

    void send(LinkId link, Delivery delivery, std::span<const std::byte> message) override {
        const auto found = links_.find(link);
        if (found == links_.end() || found->second.close_before_s > 0.0) {
            return;
        }
        WebSocketPeer& peer = found->second;
        if (peer.queue.is_empty()) {
            peer.waits_since_s = monotonic_s();
        }
        const std::uint64_t dropped = peer.queue.dropped();
        const bool fits = peer.queue.push(delivery, message);
        counts_.dropped += peer.queue.dropped() - dropped;
        counts_.most_queued_bytes = std::max(counts_.most_queued_bytes, peer.queue.bytes());
        if (fits) {
            lws_callback_on_writable(peer.wsi);
        } else {
            end(peer, LinkEnd::slow);
        }
    }

    std::size_t queued_bytes(LinkId link) const override {
        const auto found = links_.find(link);
        return found != links_.end() ? found->second.queue.bytes() : 0;
    }

    void close(LinkId link) override {
        const auto found = links_.find(link);
        if (found != links_.end() && found->second.close_before_s == 0.0) {
            found->second.close_before_s = monotonic_s() + k_close_within_s;
            lws_callback_on_writable(found->second.wsi);
        }
    }

    const ListenerCounts& counts() const override { return counts_; }

  private:
    static std::array<lws_protocols, 2> protocols() {
        std::array<lws_protocols, 2> out{};
        out[0].name = k_websocket_protocol;
        out[0].callback = &WebSocketListener::on_event;
        out[0].per_session_data_size = sizeof(WebSocketSession);
        return out;
    }
    lws_context_creation_info info() {
        constexpr unsigned k_other_files = 8;  // the listening socket, requests of metrics
        lws_context_creation_info info{};
        info.port = settings_.port;
        info.iface = settings_.address.c_str();
        info.protocols = protocols_.data();
        info.user = this;
        info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND |
                       LWS_SERVER_OPTION_SKIP_SERVER_CANONICAL_NAME |
                       (HostPort{settings_.address, 0}.is_v6()
                            ? LWS_SERVER_OPTION_IPV6_V6ONLY_MODIFY  // IPv4 too, at ::
                            : LWS_SERVER_OPTION_DISABLE_IPV6);
        info.fd_limit_per_thread = static_cast<unsigned>(settings_.most_links) + k_other_files;
        info.timeout_secs = 5;
        info.keepalive_timeout = 5;
        info.vhost_name = "default";
        return info;
    }

    // libwebsockets ends its waiting while the descriptor is readable, and does not read from it.
    // False: it has no room for another descriptor.
    bool wake_by(int descriptor) {
        lws_sock_file_fd_type other{};
        other.filefd = ::dup(descriptor);  // libwebsockets closes its own
        return other.filefd >= 0 &&
               lws_adopt_descriptor_vhost(lws_get_vhost_by_name(context_.get(), "default"),
                                          LWS_ADOPT_RAW_FILE_DESC, other, k_websocket_protocol,
                                          nullptr) != nullptr;
    }

    static int on_event(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                        std::size_t size) {
        auto* const self = static_cast<WebSocketListener*>(lws_context_user(lws_get_context(wsi)));
        if (self == nullptr || self->handler_ == nullptr) {
            return 0;  // the context begins or ends
        }
        auto* const session = static_cast<WebSocketSession*>(user);
        try {
            switch (reason) {
                case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED:
                    return self->admit_socket(wsi);
                case LWS_CALLBACK_WSI_DESTROY:
                    self->sockets_.erase(wsi);
                    return 0;
                case LWS_CALLBACK_HTTP:
                    return self->answer(wsi, {static_cast<const char*>(in), size});
                case LWS_CALLBACK_HTTP_WRITEABLE:
                    return self->write_answer(wsi);
                case LWS_CALLBACK_CLOSED_HTTP:
                    self->answers_.erase(wsi);
                    return 0;
                case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
                    // HTTP/2 would bypass the flow control.
                    return in != nullptr &&
                                   std::string_view(static_cast<const char*>(in)) == "websocket"
                               ? 0
                               : -1;
                case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
                    return self->admit();
                case LWS_CALLBACK_ESTABLISHED:
                    self->open(wsi, *session);
                    return 0;
                case LWS_CALLBACK_RECEIVE:
                    return self->receive(*session, {static_cast<const std::byte*>(in), size});
                case LWS_CALLBACK_SERVER_WRITEABLE:
                    return self->write(*session);
                case LWS_CALLBACK_CLOSED:
                    self->forget(*session);
                    return 0;
                default:
                    return 0;
            }
        } catch (const std::exception& error) {
            // The connection ends.
            ++self->counts_.failed;
            const bool is_link = session != nullptr && self->links_.contains(session->link);
            self->handler_->failed(is_link ? session->link : 0, error.what());
            return -1;
        }
    }

    int admit_socket(lws* wsi) {
        std::string address = counted_address(address_of(wsi));
        const auto same = std::ranges::count(
            sockets_, address, [](const auto& one) -> const std::string& { return one.second; });
        if (static_cast<std::size_t>(same) >= settings_.most_of_address) {
            ++counts_.refused;
            return -1;
        }
        sockets_[wsi] = std::move(address);
        return 0;
    }

    int admit() {
        if (links_.size() < settings_.most_links) {
            return 0;
        }
        ++counts_.refused;
        return -1;
    }

    void open(lws* wsi, WebSocketSession& session) {
        // The kernel's part of the queue is bounded too.
        const int& size = settings_.kernel_buffer_bytes;
        setsockopt(lws_get_socket_fd(wsi), SOL_SOCKET, SO_SNDBUF, &size, sizeof(size));
        setsockopt(lws_get_socket_fd(wsi), SOL_SOCKET, SO_RCVBUF, &size, sizeof(size));
        session.link = ++last_link_;
        links_.emplace(session.link, WebSocketPeer{.wsi = wsi,
                                                   .queue = {},
                                                   .budget = ReceiveBudget(settings_.budget),
                                                   .incoming = {},
                                                   .outgoing = {}});
        ++counts_.opened;
        handler_->opened(session.link, counted_address(address_of(wsi)));
    }

    void forget(const WebSocketSession& session) {
        const auto found = links_.find(session.link);
        if (found != links_.end()) {
            const LinkEnd end = found->second.end;
            links_.erase(found);
            handler_->closed(session.link, end);
        }
    }

    // Ends a connection that misbehaves, without waiting for its queue.
    void end(WebSocketPeer& peer, LinkEnd why) {
        if (peer.end != LinkEnd::closed) {
            return;
        }
        peer.end = why;
        counts_.bad_messages += why == LinkEnd::message ? 1U : 0U;
        counts_.ended_flooding += why == LinkEnd::flooding ? 1U : 0U;
        counts_.ended_slow += why == LinkEnd::slow ? 1U : 0U;
        lws_set_timeout(peer.wsi, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
    }

    int receive(const WebSocketSession& session, std::span<const std::byte> bytes) {
        const auto found = links_.find(session.link);
        if (found == links_.end() || found->second.end != LinkEnd::closed) {
            return -1;
        }
        WebSocketPeer& peer = found->second;
        if (lws_frame_is_binary(peer.wsi) == 0 ||
            peer.incoming.size() + bytes.size() > settings_.most_message_bytes) {
            end(peer, LinkEnd::message);
            return -1;
        }
        peer.incoming.insert(peer.incoming.end(), bytes.begin(), bytes.end());
        counts_.received_bytes += bytes.size();
        take_budget(peer, 1);
        if (lws_remaining_packet_payload(peer.wsi) > 0 || lws_is_final_fragment(peer.wsi) == 0) {
            return 0;
        }
        ++counts_.received_messages;
        if (peer.close_before_s == 0.0) {
            handler_->received(session.link, peer.incoming);
        }
        peer.incoming.clear();
        return 0;
    }

    // Stops reading from a connection that is over its budget. TCP makes its sender wait.
    void take_budget(WebSocketPeer& peer, std::size_t messages) {
        const double now_s = monotonic_s();
        const std::uint64_t read = bytes_read_from(peer.wsi);
        const std::uint64_t bytes = read - std::min(read, peer.counted_bytes);
        peer.counted_bytes = std::max(peer.counted_bytes, read);
        if (peer.budget.take(messages, bytes, now_s) || !peer.is_read) {
            return;
        }
        ++counts_.throttled;
        peer.throttles = now_s - peer.throttled_s > k_calm_s ? 1 : peer.throttles + 1;
        peer.throttled_s = now_s;
        peer.is_read = false;
        lws_rx_flow_control(peer.wsi, 0);
        if (peer.throttles > k_most_throttles) {
            end(peer, LinkEnd::flooding);
        }
    }

    void tend_links() {
        const double now_s = monotonic_s();
        for (auto& [link, peer] : links_) {
            if (now_s > peer.looked_s + k_look_s) {
                peer.looked_s = now_s;
                take_budget(peer, 0);  // what came without a message
            }
            if (!peer.is_read && peer.budget.may_read(now_s)) {
                peer.is_read = true;
                lws_rx_flow_control(peer.wsi, 1 | LWS_RXFLOW_REASON_FLAG_PROCESS_NOW);
            }
            if (!peer.queue.is_empty() && now_s - peer.waits_since_s > settings_.slow_after_s) {
                end(peer, LinkEnd::slow);
            }
            if (peer.close_before_s > 0.0 && now_s > peer.close_before_s) {
                lws_set_timeout(peer.wsi, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
            }
        }
    }

    int write(const WebSocketSession& session) {
        const auto found = links_.find(session.link);
        if (found == links_.end()) {
            return -1;
        }
        WebSocketPeer& peer = found->second;
        if (!peer.queue.is_empty()) {
            const std::span<const std::byte> message = peer.queue.front();
            peer.outgoing.resize(LWS_PRE + message.size());
            std::ranges::transform(message, peer.outgoing.begin() + LWS_PRE,
                                   [](std::byte byte) { return static_cast<unsigned char>(byte); });
            if (lws_write(peer.wsi, &peer.outgoing[LWS_PRE], message.size(), LWS_WRITE_BINARY) <
                0) {
                return -1;
            }
            ++counts_.sent_messages;
            counts_.sent_bytes += message.size();
            peer.queue.pop();
            peer.waits_since_s = monotonic_s();
        }
        if (!peer.queue.is_empty()) {
            lws_callback_on_writable(peer.wsi);
        }
        // A connection that closes is left to the other side to end, until close_before_s: closing
        // a socket with unread input resets it, and what was sent last is lost.
        return 0;
    }

    int answer(lws* wsi, std::string_view path) {
        HttpAnswer answer = handler_->get(path);
        constexpr std::size_t k_header_room = 1024;
        std::vector<unsigned char> header(LWS_PRE + k_header_room);
        unsigned char* const start = &header[LWS_PRE];
        unsigned char* at = start;
        unsigned char* const last = &header.back();
        if (lws_add_http_common_headers(wsi, static_cast<unsigned>(answer.status),
                                        "text/plain; charset=utf-8", answer.body.size(), &at,
                                        last) != 0 ||
            lws_finalize_write_http_header(wsi, start, &at, last) != 0) {
            return 1;
        }
        answers_[wsi] = std::move(answer.body);
        lws_callback_on_writable(wsi);
        return 0;
    }
    int write_answer(lws* wsi) {
        const auto found = answers_.find(wsi);
        if (found == answers_.end()) {
            return -1;
        }
        std::vector<unsigned char> body(LWS_PRE);
        body.insert(body.end(), found->second.begin(), found->second.end());
        body.push_back(0);  // never written: an empty body has an address too
        const std::size_t size = found->second.size();
        answers_.erase(found);
        (void)lws_write(wsi, &body[LWS_PRE], size, LWS_WRITE_HTTP_FINAL);
        return -1;  // one answer a connection
    }

    ListenerSettings settings_;
    std::array<lws_protocols, 2> protocols_;
    ListenerHandler* handler_ = nullptr;
    std::map<LinkId, WebSocketPeer> links_;
    std::map<lws*, std::string> answers_;  // bodies that wait to be written
    std::map<lws*, std::string> sockets_;  // addresses of all connections
    LinkId last_link_ = 0;
    ListenerCounts counts_;
    bool is_valid_ = false;
    WebSocketContext context_;  // the last one: it calls on_event while it ends
};

}  // namespace

bool has_websocket() { return true; }

Result<std::unique_ptr<Listener>> open_websocket_listener(const ListenerSettings& settings,
                                                          int descriptor) {
    auto listener = std::make_unique<WebSocketListener>(settings, descriptor);
    if (!listener->is_valid()) {
        return FileError{HostPort{settings.address, settings.port}.text(), "",
                         "expected an address and a port that are free"};
    }
    return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace handhold
