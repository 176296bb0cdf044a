// Which transport a server listens by, and a peer connects by.
#include <algorithm>
#include <array>
#include <utility>

#include "game/net/transport_kinds.hpp"

namespace handhold {
namespace {

// Tells a handler of links of one transport, numbered so that no other has the same number.
class NumberedHandler final : public ListenerHandler {
  public:
    NumberedHandler(ListenerHandler& to, LinkId which) : to_(to), which_(which) {}
    void opened(LinkId link, std::string_view address) override { to_.opened(all(link), address); }
    void received(LinkId link, std::span<const std::byte> message) override {
        to_.received(all(link), message);
    }
    void closed(LinkId link, LinkEnd why) override { to_.closed(all(link), why); }
    HttpAnswer get(std::string_view path) override { return to_.get(path); }
    void failed(LinkId link, std::string_view what) override {
        to_.failed(link == 0 ? 0 : all(link), what);
    }

  private:
    LinkId all(LinkId link) const { return 2 * link - which_; }

    ListenerHandler& to_;
    LinkId which_;  // 1: WebSocket, 0: QUIC
};

// WebSocket and QUIC at the same port, in one loop: libwebsockets waits for both sockets.
class BothListener final : public Listener {
  public:
    BothListener(std::unique_ptr<Listener> websocket, std::unique_ptr<DatagramListener> quic)
        : websocket_(std::move(websocket)), quic_(std::move(quic)) {}

    int port() const override { return websocket_->port(); }
    std::vector<std::string> urls() const override {
        std::vector<std::string> out = websocket_->urls();
        for (std::string& url : quic_->urls()) {
            out.push_back(std::move(url));
        }
        return out;
    }
    void poll(double wait_s, ListenerHandler& handler) override {
        NumberedHandler of_websocket(handler, 1);
        NumberedHandler of_quic(handler, 0);
        quic_->poll(0.0, of_quic);
        websocket_->poll(std::min(wait_s, quic_->due_in_s()), of_websocket);
        quic_->poll(0.0, of_quic);
    }
    void send(LinkId link, Delivery delivery, std::span<const std::byte> message) override {
        of(link).send(own(link), delivery, message);
    }
    std::size_t queued_bytes(LinkId link) const override {
        return is_websocket(link) ? websocket_->queued_bytes(own(link))
                                  : quic_->queued_bytes(own(link));
    }
    void close(LinkId link) override { of(link).close(own(link)); }

    const ListenerCounts& counts() const override {
        const ListenerCounts& a = websocket_->counts();
        const ListenerCounts& b = quic_->counts();
        sum_ = b;
        sum_.opened += a.opened;
        sum_.refused += a.refused;
        sum_.received_messages += a.received_messages;
        sum_.received_bytes += a.received_bytes;
        sum_.sent_messages += a.sent_messages;
        sum_.sent_bytes += a.sent_bytes;
        sum_.dropped += a.dropped;
        sum_.throttled += a.throttled;
        sum_.failed += a.failed;
        sum_.bad_messages += a.bad_messages;
        sum_.ended_flooding += a.ended_flooding;
        sum_.ended_slow += a.ended_slow;
        sum_.most_queued_bytes = std::max(a.most_queued_bytes, b.most_queued_bytes);
        return sum_;
    }

  private:
    static bool is_websocket(LinkId link) { return link % 2 == 1; }
    static LinkId own(LinkId link) { return (link + 1) / 2; }
    Listener& of(LinkId link) const { return is_websocket(link) ? *websocket_ : *quic_; }

    std::unique_ptr<Listener> websocket_;
    std::unique_ptr<DatagramListener> quic_;
    mutable ListenerCounts sum_;
};

Result<std::unique_ptr<Listener>> open_both(ListenerSettings settings) {
    Result<std::unique_ptr<DatagramListener>> quic = open_quic_listener(settings);
    if (!quic) {
        return quic.error();
    }
    settings.port = quic.value()->port();
    Result<std::unique_ptr<Listener>> websocket =
        open_websocket_listener(settings, quic.value()->descriptor());
    if (!websocket) {
        return websocket.error();
    }
    return std::unique_ptr<Listener>(
        std::make_unique<BothListener>(std::move(websocket.value()), std::move(quic.value())));
}

}  // namespace

bool has_network() { return has_websocket() || has_quic(); }

Result<std::unique_ptr<Listener>> open_listener(const ListenerSettings& settings) {
    ListenerSettings limited = settings;
    limited.most_of_address =
        std::min(settings.most_of_address, settings.most_links - settings.most_links / 4);
    if (!has_quic()) {
        return open_websocket_listener(limited);
    }
    if (!has_websocket()) {
        Result<std::unique_ptr<DatagramListener>> quic = open_quic_listener(limited);
        if (!quic) {
            return quic.error();
        }
        return std::unique_ptr<Listener>(std::move(quic.value()));
    }
    // A port that is free for UDP may be taken for TCP.
    constexpr int k_tries = 16;
    Result<std::unique_ptr<Listener>> out = open_both(limited);
    for (int i = 1; i < k_tries && !out && limited.port == 0; ++i) {
        out = open_both(limited);
    }
    return out;
}

Result<std::unique_ptr<Link>> open_link(const std::string& url) {
    if (url.starts_with("quic://")) {
        return open_quic_link(url);
    }
    return open_websocket_link(url);
}

}  // namespace handhold
