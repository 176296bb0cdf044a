#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <handhold/match.hpp>

#include "game/arena/arena_match.hpp"
#include "game/net/match_recording.hpp"
#include "game/net/net_messages.hpp"
#include "game/net/transport.hpp"

namespace handhold {

// What a player's devices say for one tick.
struct PeerInput {
    std::vector<hh::Sample> samples;  // ascending times, each once
    hh_commands commands{};
    std::uint32_t buttons = 0;
    std::uint32_t later_ticks = 0;  // in: ticks that are due after this one
};
// Sets the input of the tick that ends at `end_s` on the world's clock. The clock jumps when a
// state arrives.
using PeerHands = std::function<void(double end_s, PeerInput& input)>;

struct MatchPeerSettings {
    MatchDigests digests{};    // taken from the own level
    std::uint64_t person = 0;  // the same when the person returns
    std::string token;
    double tick_s = 1.0 / 90.0;
    double silent_after_s = 5.0;        // a server that says nothing for so long is gone
    std::function<double()> clock;      // seconds, monotonic
    ArenaGame* arena = nullptr;         // rules of the scene; must outlive the peer. Null: none
    bool watches = false;               // a spectator: the peer has no slot, and no hands
    bool unpacks = true;                // takes packed states, if this program can unpack them
    MatchRecorder* recorder = nullptr;  // must outlive the peer. Null: nothing is recorded
};

enum class PeerStage : std::uint8_t {
    connecting,
    offered,  // hello is sent
    joining,  // a state is on its way
    playing,
    ended,
};

// One player's part in a match over a transport. Runs in the caller's thread.
class MatchPeer final : public LinkHandler {
  public:
    // The world has the match's level and players, and is not stepped by anybody else. It must
    // outlive the peer.
    MatchPeer(hh::World& world, std::span<const hh::Player> players, MatchPeerSettings settings);
    ~MatchPeer() = default;
    MatchPeer(const MatchPeer&) = delete;
    MatchPeer& operator=(const MatchPeer&) = delete;

    // Joins over this link; again after the last one has ended.
    void connect(std::unique_ptr<Link> link);
    // Receives, steps the ticks that are due with what `hands` says, and sends. Waits for messages
    // at most `wait_s`. Returns the number of ticks that the world advanced.
    std::uint32_t poll(double wait_s, const PeerHands& hands);
    // Tells the server that the player leaves. Poll until `ended`.
    void leave();

    PeerStage stage() const { return stage_; }
    // False once the connection is closed, which is after `ended`.
    bool is_linked() const { return is_linked_; }
    // Why the match has ended for this peer, in one line.
    const std::string& why() const { return why_; }
    // True if another connection may bring the player back: this one was lost, or was silent.
    bool may_return() const { return may_return_; }
    // What the server said before it ended the connection.
    std::optional<NetBye> bye() const { return bye_; }
    std::size_t slot() const { return slot_; }  // no meaning for spectators
    bool watches() const { return settings_.watches; }
    std::span<const hh::Player> players() const { return players_; }  // indexed by slot
    // Not valid before the first state is restored.
    const hh::Match& match() const { return match_; }
    // States that were restored.
    std::uint64_t states() const { return states_; }
    const std::optional<MatchOffer>& offer() const { return offer_; }

    void opened() override {}
    void received(std::span<const std::byte> message) override;
    void closed(std::string_view why) override;

  private:
    void take_offer(std::span<const std::byte> message);
    void take_welcome(std::span<const std::byte> message);
    void take_piece(std::span<const std::byte> message);
    void take_state(const StatePiece& last);
    void begin_match(std::size_t slot);
    void join(std::uint8_t number);
    void end(std::string why, bool may_return = false);
    void check_silence();
    std::uint32_t step(const PeerHands& hands);

    hh::World& world_;
    std::vector<hh::Player> players_;
    MatchPeerSettings settings_;
    std::unique_ptr<Link> link_;
    std::unique_ptr<ArenaMatch> arena_;  // null: the scene has no rules
    hh::Match match_;
    PeerStage stage_ = PeerStage::ended;
    std::string why_;
    bool may_return_ = false;
    bool is_linked_ = false;
    std::optional<NetBye> bye_;
    std::size_t slot_ = 0;
    std::optional<MatchOffer> offer_;
    std::vector<std::byte> state_;  // pieces of a state that came so far
    std::uint8_t state_number_ = 0;
    std::uint64_t states_ = 0;
    double stepped_s_ = 0.0;
    double heard_s_ = 0.0;            // when the last message came
    PeerInput input_;                 // reused
    std::vector<std::byte> packet_;   // reused
    std::vector<std::byte> message_;  // reused
};

// Asks a server what is played there. Error: no server, or none of this version.
Result<MatchOffer> fetch_offer(const std::string& url, double within_s);

}  // namespace handhold
