#include "game/net/match_seats.hpp"

#include <algorithm>

namespace handhold {

std::optional<std::size_t> MatchSeats::of_link(LinkId link) const {
    for (std::size_t seat = 0; seat < count_; ++seat) {
        if (seats_[seat].stage != SeatStage::empty && seats_[seat].link == link) {
            return seat;
        }
    }
    return std::nullopt;
}

std::optional<std::size_t> MatchSeats::find_for(const std::string& person, bool watches,
                                                double now_s) const {
    std::optional<std::size_t> found;
    for (std::size_t at = first(watches); at < last(watches); ++at) {
        const MatchSeat& seat = seats_[at];
        if (seat.person == person) {
            return at;
        }
        if (!found && seat.stage == SeatStage::empty && now_s >= seat.reserved_until_s) {
            found = at;
        }
    }
    return found;
}

bool MatchSeats::has(const std::string& person, std::uint64_t number, bool watches,
                     double now_s) const {
    for (std::size_t at = first(watches); at < last(watches); ++at) {
        const MatchSeat& seat = seats_[at];
        if (seat.person == person && seat.number == number &&
            (seat.stage != SeatStage::empty || now_s < seat.reserved_until_s)) {
            return true;
        }
    }
    return false;
}

std::size_t MatchSeats::taken_of(bool watches) const {
    std::size_t count = 0;
    for (std::size_t at = first(watches); at < last(watches); ++at) {
        count += seats_[at].stage != SeatStage::empty ? 1U : 0U;
    }
    return count;
}

bool MatchSeats::is_played() const {
    return std::any_of(
        seats_.begin(), seats_.begin() + static_cast<std::ptrdiff_t>(players_),
        [](const MatchSeat& seat) { return seat.stage != SeatStage::empty && seat.has_played; });
}

std::size_t MatchSeats::taken() const { return taken_of(false); }
std::size_t MatchSeats::watching() const { return taken_of(true); }

}  // namespace handhold
