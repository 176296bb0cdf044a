#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "systems/match/confirmed_inputs.hpp"
#include "systems/match/join_state.hpp"
#include "systems/match/match_messages.hpp"
#include "systems/match/match_world.hpp"
#include "systems/match/shared/predict_input.hpp"
#include "systems/match/shared/send_marks.hpp"
#include "systems/match/shown_offsets.hpp"
#include "systems/match/tick_pacer.hpp"
#include "systems/snapshot/simulated_state.hpp"

namespace handhold {

struct ClientCounts {
    std::uint64_t ticks = 0;  // ticks that the world advanced
    std::uint64_t rollbacks = 0;
    std::uint64_t steps_again = 0;  // ticks that rollbacks stepped once more
    std::uint64_t deepest = 0;      // most ticks that one rollback stepped again
    std::uint64_t filled = 0;       // own inputs that came too late at the server
    std::uint64_t waits = 0;        // calls of advance that were too far ahead to step
    RefusalCounts refused{};
};

// One player's machine. Its world is later than the last confirmed tick: it uses own inputs at
// once, and guesses those of others until they arrive. Each advance first goes back to the state
// before the first wrong guess and steps again to the present, without shown stages.
//
// No sockets and no clock: the host hands packets in, takes packets out, and says when to advance.
// No allocation once warm, except in join. 3 MB: allocate it on the heap.
class ClientSession {
  public:
    // Number of states kept; the world is fewer ticks than this after the last confirmed one.
    static constexpr MatchTick k_window = k_match_window;

    // The world is at a tick at which the server's is or was equal, and before which nobody played:
    // the start of a match. Else call join before anything else. `slot`: of this machine's player.
    ClientSession(const MatchWorld& match, std::size_t slot);

    // Replaces the world by the server's, as of a confirmed tick. Tolerates any bytes. On error
    // nothing changes. A host with state of its own sets it to that of the tick before it advances.
    [[nodiscard]] std::optional<FileError> join(std::span<const std::byte> state,
                                                const SnapshotAssets& assets,
                                                const MissingHeads& heads = {});

    // Takes a packet of the server. Refused packets change nothing, and are counted.
    MatchRefusal receive(std::span<const std::byte> packet);
    // How many times to call advance for so much time of the local clock: about one a tick, a
    // little more or less so that inputs reach the server just before their deadlines.
    int ticks_due(double elapsed_s) { return pacer_.ticks_due(elapsed_s, match_.dt_s); }
    // See TickPacer::past_ticks.
    double past_ticks() const { return pacer_.past_ticks(); }
    // Steps the world by one tick with the own input. Only the last of several calls in a frame
    // needs to be shown. False: nothing was confirmed for k_window ticks, so the world waits.
    bool advance(const MatchInput& own, bool is_shown = true);
    // Writes the next packet to the server; returns its size. Call once a tick or once in two.
    std::size_t write_packet(std::span<std::byte> bytes);

    const MatchWorld& match() const { return match_; }
    MatchTick now() const { return match_.world.clock.frame; }
    // All inputs up to this tick are final, and this machine has them. It may be later than now().
    MatchTick confirmed() const;
    // The world's states up to this tick are final. Inputs that arrived since the last advance may
    // still need a rollback.
    MatchTick final_state() const;
    // True if the state after the tick is kept: a tick of the last k_window ones that this machine
    // has stepped.
    bool has_state(MatchTick tick) const {
        return is_start_kept_ && tick >= oldest_state_ && tick <= now();
    }
    // Writes the inputs of ticks after `after` whose state is final, as write_confirmed; `until`
    // gets the last tick written. Returns the size. Precondition: can_write_after.
    std::size_t write_watched(MatchTick after, MatchTick& until, std::span<std::byte> bytes) const;
    // False for later ticks than final_state(), and where inputs after the tick are forgotten.
    bool can_write_after(MatchTick after) const;
    // The match's hash (match_hash) after a tick. Equal on all machines up to final_state().
    // Precondition: has_state.
    std::uint64_t hash_at(MatchTick tick) const {
        return match_hash(match_, states_[tick % k_window].hash(), host_hashes_[tick % k_window]);
    }
    // True if the server's hash of a confirmed tick differs from this world's, or the server has
    // dropped inputs that this machine lacks: the host must fetch a new state and call join.
    bool needs_state() const { return needs_state_; }
    // What to add to the drawn positions of players; indexed by slot, m.
    const PointsOfAll& shown_offsets() const { return shown_.offsets(); }
    const ClientCounts& counts() const { return counts_; }
    const StageStats& stats() const { return stats_; }  // statistics of the last step
    const InputHistory& inputs_of(std::size_t slot) const { return histories_[slot]; }

  private:
    std::span<InputHistory> histories() { return std::span(histories_).first(match_.player_count); }
    std::span<const InputHistory> histories() const {
        return std::span(histories_).first(match_.player_count);
    }
    void start_here();
    void take_stream(std::size_t slot, const StreamPart& part);
    void finish_tick(std::size_t slot, const MatchInput& input, InputKind kind);
    void choose_inputs(MatchTick tick);
    void keep_state();
    void step_once(bool is_shown);
    void go_back();
    void note_hash();

    MatchWorld match_;
    std::size_t slot_;
    std::array<InputHistory, k_most_match_players> histories_;  // what is used in each tick
    InputHistory sent_;             // own inputs, as they are sent, also if the server filled them
    MatchTick received_until_ = 0;  // the server has received these up to this tick
    std::array<InputTrend, k_most_match_players> trends_;
    std::array<MatchTick, k_most_match_players> trend_of_until_{};  // final_until() of the trend
    std::array<SimulatedState, k_window>
        states_;  // states after each tick, indexed by tick % k_window
    std::array<std::uint64_t, k_window> host_hashes_{};  // hashes of the host's state, likewise
    MatchTick oldest_state_ = 0;
    bool is_start_kept_ = false;  // the state of the first tick is kept by the first advance
    MatchTick first_wrong_ = 0;   // a tick that was stepped with other inputs than the final ones
    bool has_wrong_ = false;
    ShownOffsets shown_;
    SendMarks marks_;
    std::uint64_t packets_ = 0;
    TickPacer pacer_;
    MatchTick sent_until_ = 0;       // the newest input of the last packet
    std::array<bool, 8> had_two_{};  // packets with more than one new input
    MatchTick hash_tick_ = 0;        // the last tick that all machines compare
    HashMarks hashes_;
    bool needs_state_ = false;
    std::uint8_t state_epoch_ = 0;
    ClientCounts counts_;
    StageStats stats_;
    ServerPacket incoming_;
    TickScratch scratch_;
};

}  // namespace handhold
