#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <handhold/match.h>

#include "game/net/pack_state.hpp"
#include "game/net/transport.hpp"

namespace handhold {

enum class SeatStage : std::uint8_t {
    empty,    // nobody plays the slot
    joining,  // a state is on its way
    playing,
};

// One slot of a match, and who plays it.
struct MatchSeat {
    SeatStage stage = SeatStage::empty;
    LinkId link = 0;
    std::string person;             // who plays, or played last; empty: nobody did
    std::uint64_t number = 0;       // MatchHello::person
    bool has_played = false;        // true: that person has had the match's state
    double reserved_until_s = 0.0;  // while the seat is empty, it waits for that person
    // How long nothing has come of a player, or a state has taken. Pauses of the server do not
    // count.
    double waited_s = 0.0;
    bool needs_state = false;             // joining: its turn has not come yet
    std::vector<std::byte> state;         // a join state on its way
    std::unique_ptr<StatePacker> packer;  // null: `state` is complete
    bool unpacks = false;                 // the peer takes packed states
    bool is_packed = false;               // true: `state` is packed
    std::size_t state_sent = 0;           // bytes of it
    std::uint8_t state_number = 0;
    double state_credit_bytes = 0.0;  // what pacing allows now
    std::uint64_t watched_until = 0;  // spectators: the last tick that was sent
};

// The slots of a match, and after them the places of spectators.
class MatchSeats {
  public:
    static constexpr std::size_t k_most_spectators = 64;

    // Precondition: at most HH_MATCH_PLAYERS and k_most_spectators.
    MatchSeats(std::size_t players, std::size_t spectators)
        : players_(players), count_(players + spectators) {}

    std::size_t players() const { return players_; }
    std::size_t count() const { return count_; }
    bool is_watching(std::size_t seat) const { return seat >= players_; }
    MatchSeat& at(std::size_t slot) { return seats_[slot]; }
    const MatchSeat& at(std::size_t slot) const { return seats_[slot]; }
    std::optional<std::size_t> of_link(LinkId link) const;
    // The seat for that person: their own, else one that nobody has or waits for. nullopt: full.
    std::optional<std::size_t> find_for(const std::string& person, bool watches,
                                        double now_s) const;
    // True if that person plays, or their seat waits for them; `number` tells the person's machine.
    bool has(const std::string& person, std::uint64_t number, bool watches, double now_s) const;
    std::size_t taken() const;  // players
    // True while somebody is there, or back on the way, who has had the match's state.
    bool is_played() const;
    std::size_t watching() const;  // spectators

  private:
    std::size_t first(bool watches) const { return watches ? players_ : 0; }
    std::size_t last(bool watches) const { return watches ? count_ : players_; }
    std::size_t taken_of(bool watches) const;

    std::size_t players_;
    std::size_t count_;
    std::array<MatchSeat, HH_MATCH_PLAYERS + k_most_spectators> seats_;
};

}  // namespace handhold
