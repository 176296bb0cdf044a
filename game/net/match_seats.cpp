#include "game/net/match_seats.hpp"

namespace handhold {

std::optional<std::size_t> MatchSeats::of_link(LinkId link) const {
    for (std::size_t slot = 0; slot < count_; ++slot) {
        if (seats_[slot].stage != SeatStage::empty && seats_[slot].link == link) {
            return slot;
        }
    }
    return std::nullopt;
}

std::optional<std::size_t> MatchSeats::find_for(const std::string& person, double now_s) const {
    std::optional<std::size_t> found;
    for (std::size_t slot = 0; slot < count_; ++slot) {
        const MatchSeat& seat = seats_[slot];
        if (seat.person == person) {
            return slot;
        }
        if (!found && seat.stage == SeatStage::empty && now_s >= seat.reserved_until_s) {
            found = slot;
        }
    }
    return found;
}

std::size_t MatchSeats::taken() const {
    std::size_t count = 0;
    for (std::size_t slot = 0; slot < count_; ++slot) {
        count += seats_[slot].stage != SeatStage::empty ? 1U : 0U;
    }
    return count;
}

}  // namespace handhold
