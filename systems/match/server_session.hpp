#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "systems/match/confirmed_inputs.hpp"
#include "systems/match/join_state.hpp"
#include "systems/match/match_messages.hpp"
#include "systems/match/match_world.hpp"
#include "systems/match/shared/predict_input.hpp"
#include "systems/match/shared/send_marks.hpp"

namespace handhold {

struct ServerCounts {
    std::uint64_t ticks = 0;        // confirmed ticks
    std::uint64_t filled = 0;       // predicted inputs of connected players
    std::uint64_t late = 0;         // inputs that came after their tick was filled
    std::uint64_t hashes = 0;       // compared hashes of confirmed ticks
    std::uint64_t out_of_sync = 0;  // compared hashes that differed
    RefusalCounts refused{};
};

// The machine that orders a match's inputs. Each input is passed on as soon as it arrives. A tick
// is confirmed, and the server's world steps it, once all connected players' inputs are there, or
// at the tick's deadline, which is its end on the server's clock: what is missing then is filled
// with predict_input and flagged. So nobody waits for anybody, and nobody drives the match faster
// than the clock: no tick is confirmed more than k_most_early_s before its deadline. Each player
// learns how long their inputs waited, and runs ahead by as much as their own connection needs
// (TickPacer).
//
// No sockets and no clock: the host hands packets in with their times, says what time it is, and
// takes packets out. No allocation once warm, except in write_state.
class ServerSession {
  public:
    // Inputs may be this far ahead of the confirmed ticks.
    static constexpr MatchTick k_most_lead = 128;
    static constexpr double k_most_early_s = 0.1;
    // A player is sent states at most so often. The state must arrive within 448 ticks (five
    // seconds): the inputs after it are forgotten then, and the player needs another.
    static constexpr MatchTick k_state_every_ticks = 90;

    // The world is at the start of the match, at `start_s` on the host's clock.
    ServerSession(const MatchWorld& match, double start_s);

    // Whether somebody plays the slot. Nobody waits for a slot that is not connected: its hands let
    // go and its body floats until somebody connects.
    void connect(std::size_t slot);
    void disconnect(std::size_t slot) { peers_[slot].is_connected = false; }
    bool is_connected(std::size_t slot) const { return peers_[slot].is_connected; }

    // Takes a packet that came from the player of that slot. Refused packets change nothing, and
    // are counted.
    MatchRefusal receive(std::size_t slot, std::span<const std::byte> packet, double now_s);
    // Confirms and steps all ticks that are complete or due, at most `most`.
    void advance(double now_s, std::size_t most = 16);
    // Writes the next packet to a player; returns its size.
    std::size_t write_packet(std::size_t slot, std::span<std::byte> bytes);

    // True if the player lacks inputs that are forgotten, or has a wrong world: send write_state's
    // bytes over a reliable stream.
    bool needs_state(std::size_t slot) const { return peers_[slot].needs_state; }
    // The state for a player to join. From now on the player is sent the inputs after it.
    void write_state(std::size_t slot, const SnapshotAssets& assets, std::vector<std::byte>& bytes);
    // The bytes that write_state would write. Nothing changes.
    void preview_state(std::size_t slot, const SnapshotAssets& assets,
                       std::vector<std::byte>& bytes) const;

    // The state for a spectator to join.
    void write_state_to_watch(const SnapshotAssets& assets, std::vector<std::byte>& bytes) const;
    // Writes the inputs of confirmed ticks after `after`, as write_confirmed; `until` gets the last
    // tick written. Returns the size. Precondition: can_write_after.
    std::size_t write_watched(MatchTick after, MatchTick& until, std::span<std::byte> bytes) const;
    // False for later ticks than confirmed(), and where inputs after the tick are forgotten.
    bool can_write_after(MatchTick after) const;

    // The match's hash (match_hash) after the last confirmed tick.
    std::uint64_t hash() const;

    MatchTick confirmed() const { return match_.world.clock.frame; }
    const ServerCounts& counts() const { return counts_; }
    const StageStats& stats() const { return stats_; }  // statistics of the last step
    const InputHistory& inputs_of(std::size_t slot) const { return histories_[slot]; }

  private:
    // Least wait of a player's inputs, over the last one to two spans of k_span inputs.
    struct Waits {
        static constexpr int k_span = 45;
        double now_s = 0.0;
        double before_s = 0.0;
        int count = -1;  // -1: none yet

        void add(double wait_s);
        double least_s() const;
    };
    struct Peer {
        bool is_connected = false;
        bool needs_state = false;
        std::uint8_t state_epoch = 0;
        std::array<MatchTick, k_most_match_players> known_until{};
        std::array<SendMarks, k_most_match_players> marks;
        std::uint64_t packets = 0;
        MatchTick compared_until = 0;
        MatchTick newest = 0;  // the newest tick of all packets
        std::uint8_t lead_epoch = 0;
        Waits waits;
        MatchTick next_state_at = 0;  // no state is sent before this tick is confirmed

        void forget_lead() {
            newest = 0;
            lead_epoch = 0;
            waits = {};
        }
    };
    std::span<InputHistory> histories() { return std::span(histories_).first(match_.player_count); }
    std::span<const InputHistory> histories() const {
        return std::span(histories_).first(match_.player_count);
    }
    double deadline_s(MatchTick tick) const {
        return start_s_ + static_cast<double>(tick - start_tick_) * match_.dt_s;
    }
    void take_inputs(std::size_t slot, const StreamPart& part, double now_s);
    void compare_hash(Peer& peer, MatchTick tick, std::uint64_t hash);
    void ask_for_state(Peer& peer) const;
    bool is_complete(MatchTick tick) const;
    void confirm(MatchTick tick);

    MatchWorld match_;
    double start_s_;
    MatchTick start_tick_;
    std::array<InputHistory, k_most_match_players> histories_;  // what is used in each tick
    // What each player sent, in order, also if it came after its tick was filled.
    std::array<InputHistory, k_most_match_players> sent_;
    std::array<Peer, k_most_match_players> peers_;
    HashMarks hashes_;
    ServerCounts counts_;
    StageStats stats_;
    ClientPacket incoming_;
    TickScratch scratch_;
};

}  // namespace handhold
