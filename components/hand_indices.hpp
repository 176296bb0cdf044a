#pragma once

#include <algorithm>

#include "components/grab.hpp"
#include "engine/ecs/column.hpp"

// Finds a player's hands in the columns, and tells how two hands of one player grip.
namespace handhold {

// Returns the index of a hand of `player` in the column, or the column's size if the player has no
// hand. Searches from index `from` and wraps around at the end. A player's hands are usually
// adjacent, so that a good `from` needs one or two steps.
inline std::size_t find_hand_index(const Column<HandOwner>& owner, Entity player,
                                   std::size_t from) {
    const std::size_t count = owner.size();
    for (std::size_t step = 0; step < count; ++step) {
        const std::size_t index = (from + step) % count;
        if (owner.elements()[index].player == player) {
            return index;
        }
    }
    return count;
}

// `index` is the index of a hand in `grab`. Returns the index of the same player's other hand;
// grab.size() if there is none.
inline std::size_t find_other_hand(const Column<HandOwner>& owner, const Column<Grab>& grab,
                                   std::size_t index) {
    const std::size_t own = owner.find_index(grab.owners()[index]);
    const Entity player = owner.elements()[own].player;
    // The left hand usually comes just before the right hand.
    const std::size_t adjacent =
        owner.elements()[own].side == HandSide::left ? own + 1 : own + owner.size() - 1;
    std::size_t other = find_hand_index(owner, player, adjacent);
    if (other == own) {
        other = find_hand_index(owner, player, own + 1);
    }
    const std::size_t found =
        other == own ? Column<Grab>::k_npos : grab.find_index(owner.owners()[other]);
    return found == Column<Grab>::k_npos ? grab.size() : found;
}

// True if two hands of one player hold the same free body, and no joints connect it to something
// that a hand cannot move.
inline bool share_free_body(const Grab& a, const Grab& b) {
    return a.kind == GripKind::held && b.kind == GripKind::held && a.body == b.body && !a.jointed &&
           !b.jointed;
}

// True if two hands of one player grip together: both on surfaces, or both on the same body. If
// their targets contradict each other, the position error is divided between them. When one hand
// lets go, the other gets a new anchor.
inline bool share_hold(const Grab& a, const Grab& b) {
    const bool both_fixed = a.kind == GripKind::surface && b.kind == GripKind::surface;
    return both_fixed || (a.kind != GripKind::none && a.kind == b.kind && a.body == b.body);
}

// True if `staying` must take a new anchor when `leaving`, the player's other hand, lets go: else
// the player or the held body would jump by what the two hands had divided between them. Hands on
// different bodies (a rail and a drawer at its end) contradict each other if both have an error.
inline bool binds(const Grab& leaving, const Grab& staying) {
    constexpr double k_contradicts_m = 1e-4;
    return share_hold(leaving, staying) ||
           (staying.kind != GripKind::none &&
            std::min(leaving.error_m, staying.error_m) > k_contradicts_m);
}

// True if the hand at `index` is the first of two hands on one body: the hand that closed earlier,
// or the left hand if both closed at the same time.
inline bool is_first_hand(const Column<HandOwner>& owner, const Column<Grab>& grab,
                          std::size_t index, std::size_t other) {
    const double difference_s = grab.elements()[index].since_s - grab.elements()[other].since_s;
    return difference_s != 0.0 ? difference_s < 0.0
                               : owner.at(grab.owners()[index]).side == HandSide::left;
}

}  // namespace handhold
