#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <handhold/match.h>

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
    double reserved_until_s = 0.0;  // while the seat is empty, it waits for that person
    // How long nothing has come of a player, or a state has taken. Pauses of the server do not
    // count.
    double waited_s = 0.0;
    std::vector<std::byte> state;  // a join state on its way
    std::size_t state_sent = 0;    // bytes of it
    std::uint8_t state_number = 0;
    double state_credit_bytes = 0.0;  // what pacing allows now
};

// The slots of a match.
class MatchSeats {
  public:
    explicit MatchSeats(std::size_t count) : count_(count) {}

    std::size_t count() const { return count_; }
    MatchSeat& at(std::size_t slot) { return seats_[slot]; }
    const MatchSeat& at(std::size_t slot) const { return seats_[slot]; }
    std::optional<std::size_t> of_link(LinkId link) const;
    // The seat for that person: their own, else one that nobody has or waits for. nullopt: full.
    std::optional<std::size_t> find_for(const std::string& person, double now_s) const;
    std::size_t taken() const;

  private:
    std::size_t count_;
    std::array<MatchSeat, HH_MATCH_PLAYERS> seats_;
};

}  // namespace handhold
