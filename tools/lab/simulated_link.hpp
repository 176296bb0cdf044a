#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "game/net/transport.hpp"
#include "tools/lab/match_network.hpp"

// The transports of game/net over a simulated network, on a clock of the caller's.
namespace handhold::lab {

// The network between a server and its peers. Messages of Delivery::newest are datagrams;
// reliable ones arrive in order, after the delay alone.
class SimulatedWire {
  public:
    SimulatedWire(const NetworkTraits& traits, std::uint64_t seed, std::size_t peers)
        : datagrams_(traits, seed),
          streams_({.delay_s = traits.delay_s, .jitter_s = 0.0}, seed),
          arrived_(peers + 1) {}

    std::size_t peers() const { return arrived_.size() - 1; }
    std::size_t server() const { return peers(); }  // place of the server; a peer's is its index
    void send(std::size_t from, std::size_t to, Delivery delivery,
              std::span<const std::byte> bytes) {
        (delivery == Delivery::newest ? datagrams_ : streams_).send(from, to, bytes, now_s);
    }
    // Calls take(from, bytes) for all messages that are due at a place.
    template <typename Take>
    void receive(std::size_t at, const Take& take) {
        const auto keep = [this](std::size_t from, std::size_t to, std::span<const std::byte> got) {
            arrived_[to].emplace_back(from, std::vector<std::byte>(got.begin(), got.end()));
        };
        streams_.deliver(now_s, keep);
        datagrams_.deliver(now_s, keep);
        while (!arrived_[at].empty()) {
            const auto [from, bytes] = std::move(arrived_[at].front());
            arrived_[at].pop_front();
            take(from, std::span<const std::byte>(bytes));
        }
    }
    int lost() const { return datagrams_.lost(); }

    double now_s = 0.0;

  private:
    SimulatedNetwork datagrams_;
    SimulatedNetwork streams_;
    std::vector<std::deque<std::pair<std::size_t, std::vector<std::byte>>>> arrived_;
};

// The server's end. Links are numbered from 1, by peer.
class SimulatedListener final : public Listener {
  public:
    explicit SimulatedListener(SimulatedWire& wire) : wire_(wire) {}

    int port() const override { return 0; }
    void poll(double /*wait_s*/, ListenerHandler& handler) override {
        for (; opened_ < wire_.peers(); ++opened_) {
            handler.opened(opened_ + 1, "127.0.0.1");
        }
        wire_.receive(wire_.server(), [&](std::size_t from, std::span<const std::byte> bytes) {
            handler.received(from + 1, bytes);
        });
    }
    void send(LinkId link, Delivery delivery, std::span<const std::byte> message) override {
        wire_.send(wire_.server(), static_cast<std::size_t>(link) - 1, delivery, message);
    }
    std::size_t queued_bytes(LinkId /*link*/) const override { return 0; }
    void close(LinkId /*link*/) override {}
    const ListenerCounts& counts() const override { return counts_; }

  private:
    SimulatedWire& wire_;
    std::size_t opened_ = 0;
    ListenerCounts counts_;
};

// A peer's end.
class SimulatedLink final : public Link {
  public:
    SimulatedLink(SimulatedWire& wire, std::size_t peer) : wire_(wire), peer_(peer) {}

    void poll(double /*wait_s*/, LinkHandler& handler) override {
        if (!std::exchange(is_opened_, true)) {
            handler.opened();
        }
        wire_.receive(peer_, [&](std::size_t /*from*/, std::span<const std::byte> bytes) {
            handler.received(bytes);
        });
    }
    void send(Delivery delivery, std::span<const std::byte> message) override {
        wire_.send(peer_, wire_.server(), delivery, message);
    }
    std::size_t queued_bytes() const override { return 0; }
    void close() override {}

  private:
    SimulatedWire& wire_;
    std::size_t peer_;
    bool is_opened_ = false;
};

}  // namespace handhold::lab
