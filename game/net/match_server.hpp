#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <handhold/match.hpp>

#include "game/arena/arena_match.hpp"
#include "game/net/join_limits.hpp"
#include "game/net/match_recording.hpp"
#include "game/net/match_seats.hpp"
#include "game/net/net_log.hpp"
#include "game/net/net_messages.hpp"
#include "game/net/token.hpp"
#include "game/net/transport.hpp"

namespace handhold {

struct MatchServerSettings {
    MatchOffer offer;             // `players` and `wants_token` are set by the server
    std::optional<TokenKey> key;  // none: everybody is admitted
    double tick_s = 1.0 / 90.0;
    double return_s = 60.0;            // a seat waits so long for a person who was cut off
    double state_bytes_per_s = 500e3;  // most to one peer
    double state_within_s = 2.5;       // large states are sent faster, to arrive in that time
    // States are packed at this rate, one after the other: about 0.6 ms of the processor in a tick.
    // After a longer pause more at once, because a state must arrive in time.
    double packed_bytes_per_s = 16e6;
    std::size_t spectators = 8;  // places for them
    JoinRate joins{4.0, 32.0};
    JoinRate joins_of_address{2.0, 16.0};  // limit of an address, without tokens
    JoinRate joins_of_person{0.5, 4.0};    // limit of a person, with tokens
    JoinRate metrics{10.0, 10.0};          // answers to GET /metrics
    double hello_within_s = 5.0;           // limit for a hello, and for a state once it is sent
    double silent_after_s = 10.0;          // a player without a good packet is sent away
    double longest_wait_s = 0.01;          // limit of one poll
    std::function<double()> clock;         // seconds, monotonic
    std::function<std::int64_t()> today;   // Unix time, for tokens
    NetLog log;
    ArenaGame* arena = nullptr;         // rules of the scene; must outlive the server. Null: none
    MatchRecorder* recorder = nullptr;  // must outlive the server. Null: nothing is recorded
};

// Sums since the server began.
struct MatchServerCounts {
    std::uint64_t joins = 0;
    std::uint64_t returns = 0;  // joins of a person who had played before
    std::uint64_t states = 0;
    std::uint64_t state_bytes = 0;         // bytes before packing
    std::uint64_t state_bytes_packed = 0;  // bytes after packing
    std::uint64_t bad_packets = 0;   // packets of the match that it refused as damaged or forged
    std::uint64_t bad_messages = 0;  // other messages that were none
    std::uint64_t silent = 0;        // peers that were sent away for it
    std::uint64_t failed = 0;        // ListenerHandler::failed
    std::uint64_t late = 0;
    std::array<std::uint64_t, k_net_refusals> refused{};  // indexed by NetRefusal
};

// A match that peers join over a transport: `handhold serve`. Runs in the caller's thread.
class MatchServer final : public ListenerHandler {
  public:
    // The match begins now, at the world's present tick. World and listener must outlive it.
    MatchServer(hh::World& world, std::span<const hh::Player> players, MatchServerSettings settings,
                Listener& listener);
    ~MatchServer() = default;
    MatchServer(const MatchServer&) = delete;
    MatchServer& operator=(const MatchServer&) = delete;

    // Receives, steps what is due, and sends. Waits at most until the next tick is due.
    void poll();
    // Admits nobody any more, and tells all peers that the server ends. Poll until is_drained.
    void drain();
    bool is_drained() const { return is_draining_ && links_.empty(); }

    const hh::Match& match() const { return match_; }
    const MatchSeats& seats() const { return seats_; }
    const MatchServerCounts& counts() const { return counts_; }
    // Prometheus' text format.
    std::string metrics() const;

    void opened(LinkId link, std::string_view address) override;
    void received(LinkId link, std::span<const std::byte> message) override;
    void closed(LinkId link, LinkEnd why) override;
    HttpAnswer get(std::string_view path) override;
    void failed(LinkId link, std::string_view what) override;

  private:
    void take_hello(LinkId link, std::span<const std::byte> message);
    // Who says so, or why not.
    std::optional<MatchRefused> check_hello(const MatchHello& hello, std::string& person) const;
    void refuse_link(LinkId link, const MatchRefused& refused);
    void seat(LinkId link, std::size_t slot, const std::string& person, const MatchHello& hello);
    void ask_for_state(std::size_t slot);
    bool is_packing() const;
    void begin_state(std::size_t slot);
    double state_rate(const MatchSeat& seat) const;
    void pack_state_of(MatchSeat& seat, std::size_t& left_bytes);
    void send_state(MatchSeat& seat, double elapsed_s);
    void send_inputs(std::size_t place);
    void take_packet(LinkId link, std::span<const std::byte> packet);
    void take_joined(LinkId link, std::span<const std::byte> message);
    void empty_seat(std::size_t slot, double reserved_s);
    void send_away(LinkId link, NetBye why);
    void tend(double now_s);
    void send_packets();
    std::string seat_name(std::size_t seat) const;
    void log(std::string_view event, std::initializer_list<NetField> fields) const;

    MatchServerSettings settings_;
    Listener& listener_;
    double start_s_;
    std::unique_ptr<ArenaMatch> arena_;  // null: the scene has no rules
    hh::Match match_;
    MatchSeats seats_;
    struct ServedLink {
        std::string address;
        double waited_s = 0.0;  // how long it has existed, without pauses
    };
    std::map<LinkId, ServedLink> links_;
    MatchServerCounts counts_;
    std::vector<std::byte> packet_;   // reused
    std::vector<std::byte> message_;  // reused
    double polled_s_;
    JoinLimits joins_;
    double metrics_left_;
    double next_packets_s_ = 0.0;
    bool is_draining_ = false;
};

}  // namespace handhold
