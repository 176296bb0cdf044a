// A peer's WebSocket connection to a server, by libwebsockets.
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "game/net/host_port.hpp"
#include "game/net/net_messages.hpp"
#include "game/net/send_queue.hpp"
#include "game/net/transport_kinds.hpp"
#include "game/net/websocket_context.hpp"

namespace handhold {
namespace {

// A server's message has a piece of a state at most.
constexpr std::size_t k_most_from_server = StatePiece::k_most_bytes + 64;

struct WebSocketUrl {
    bool is_secure = false;
    HostPort place;
    std::string path;
};

std::optional<WebSocketUrl> parse_url(std::string_view url) {
    WebSocketUrl out;
    out.is_secure = url.starts_with("wss://");
    if (!out.is_secure && !url.starts_with("ws://")) {
        return std::nullopt;
    }
    url.remove_prefix(out.is_secure ? 6 : 5);
    const std::size_t slash = std::min(url.find('/'), url.size());
    out.path = slash < url.size() ? std::string(url.substr(slash)) : "/";
    std::optional<HostPort> place = read_host_port(url.substr(0, slash), out.is_secure ? 443 : 80);
    if (!place) {
        return std::nullopt;
    }
    out.place = std::move(*place);
    return out;
}

class WebSocketLink final : public Link {
  public:
    explicit WebSocketLink(WebSocketUrl url)
        : url_(std::move(url)), host_(url_.place.host_text()), protocols_(protocols()) {
        // A name whose addresses of IPv6 lead nowhere may have one of IPv4 that works: that comes
        // first.
        families_ = url_.place.is_v6() ? 0 : LWS_SERVER_OPTION_DISABLE_IPV6;
        connect();
    }

    void poll(double wait_s, LinkHandler& handler) override {
        handler_ = &handler;
        if (!is_closed_) {
            context_->service(wait_s);
        }
        if (is_closed_ && !has_opened_ && families_ != 0 && !is_address(url_.place.host)) {
            context_ = nullptr;
            families_ = 0;
            is_closed_ = false;
            connect();
        }
        handler_ = nullptr;
        if (is_closed_ && !is_told_) {
            is_told_ = true;
            handler.closed(why_);
        }
    }

    void send(Delivery delivery, std::span<const std::byte> message) override {
        if (is_closed_ || closes_) {
            return;
        }
        if (!queue_.push(delivery, message)) {
            closes_ = true;
        }
        ask_to_write();
    }

    std::size_t queued_bytes() const override { return queue_.bytes(); }

    void close() override {
        closes_ = true;
        ask_to_write();
    }

  private:
    void connect() {
        context_ = std::make_unique<WebSocketContext>(info());
        if (context_->get() == nullptr) {
            end("no connection can be made");
            return;
        }
        lws_client_connect_info wanted{};
        wanted.context = context_->get();
        wanted.address = url_.place.host.c_str();
        wanted.host = host_.c_str();
        wanted.origin = host_.c_str();
        wanted.port = url_.place.port;
        wanted.path = url_.path.c_str();
        wanted.protocol = k_websocket_protocol;
        wanted.ssl_connection = url_.is_secure ? LCCSCF_USE_SSL : 0;
        wanted.pwsi = &wsi_;
        if (lws_client_connect_via_info(&wanted) == nullptr) {
            end("no connection");
        }
    }
    static std::array<lws_protocols, 2> protocols() {
        std::array<lws_protocols, 2> out{};
        out[0].name = k_websocket_protocol;
        out[0].callback = &WebSocketLink::on_event;
        return out;
    }
    lws_context_creation_info info() {
        lws_context_creation_info info{};
        info.port = CONTEXT_PORT_NO_LISTEN;
        info.protocols = protocols_.data();
        info.user = this;
        info.options = families_;
        if (url_.is_secure) {
            info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        }
        info.fd_limit_per_thread = 8;
        info.timeout_secs = 10;
        return info;
    }

    static int on_event(lws* wsi, lws_callback_reasons reason, void* /*user*/, void* in,
                        std::size_t size) {
        auto* const self = static_cast<WebSocketLink*>(lws_context_user(lws_get_context(wsi)));
        if (self == nullptr) {
            return 0;
        }
        try {
            switch (reason) {
                case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
                    self->end(in != nullptr ? std::string(static_cast<const char*>(in), size)
                                            : "no connection");
                    return 0;
                case LWS_CALLBACK_CLIENT_ESTABLISHED:
                    self->is_open_ = self->has_opened_ = true;
                    self->ask_to_write();
                    if (self->handler_ != nullptr) {
                        self->handler_->opened();
                    }
                    return 0;
                case LWS_CALLBACK_CLIENT_RECEIVE:
                    return self->receive({static_cast<const std::byte*>(in), size});
                case LWS_CALLBACK_CLIENT_WRITEABLE:
                    return self->write();
                case LWS_CALLBACK_CLIENT_CLOSED:
                    self->end("the connection was lost");
                    return 0;
                default:
                    return 0;
            }
        } catch (const std::exception& error) {
            self->end(std::string("this program failed: ") + error.what());
            return -1;
        }
    }

    void end(const std::string& why) {
        is_open_ = false;
        if (!is_closed_) {
            is_closed_ = true;
            why_ = printable(why);
        }
    }

    void ask_to_write() {
        if (is_open_ && !is_closed_) {
            lws_callback_on_writable(wsi_);
        }
    }

    int receive(std::span<const std::byte> bytes) {
        if (incoming_.size() + bytes.size() > k_most_from_server) {
            return -1;
        }
        incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
        if (lws_remaining_packet_payload(wsi_) == 0 && lws_is_final_fragment(wsi_) != 0) {
            if (handler_ != nullptr) {
                handler_->received(incoming_);
            }
            incoming_.clear();
        }
        return 0;
    }

    int write() {
        if (!queue_.is_empty()) {
            const std::span<const std::byte> message = queue_.front();
            outgoing_.resize(LWS_PRE + message.size());
            std::ranges::transform(message, outgoing_.begin() + LWS_PRE,
                                   [](std::byte byte) { return static_cast<unsigned char>(byte); });
            if (lws_write(wsi_, &outgoing_[LWS_PRE], message.size(), LWS_WRITE_BINARY) < 0) {
                return -1;
            }
            queue_.pop();
        }
        if (!queue_.is_empty()) {
            lws_callback_on_writable(wsi_);
        }
        return queue_.is_empty() && closes_ ? -1 : 0;
    }

    WebSocketUrl url_;
    std::string host_;            // name or address, as in URLs
    std::uint64_t families_ = 0;  // options of libwebsockets
    std::array<lws_protocols, 2> protocols_;
    LinkHandler* handler_ = nullptr;
    lws* wsi_ = nullptr;
    SendQueue queue_;
    std::vector<std::byte> incoming_;
    std::vector<unsigned char> outgoing_;
    bool is_open_ = false;
    bool has_opened_ = false;
    bool closes_ = false;
    bool is_closed_ = false;
    bool is_told_ = false;
    std::string why_;
    // The last one: it calls on_event while it ends.
    std::unique_ptr<WebSocketContext> context_;
};

}  // namespace

Result<std::unique_ptr<Link>> open_websocket_link(const std::string& url) {
    std::optional<WebSocketUrl> parsed = parse_url(url);
    if (!parsed) {
        return FileError{url, "", "expected ws://HOST:PORT or wss://HOST:PORT"};
    }
    return std::unique_ptr<Link>(std::make_unique<WebSocketLink>(std::move(*parsed)));
}

}  // namespace handhold
