#pragma once

#include "components/grab.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// The row of a player's hand, going round the column from row `from`; the column's size where he
// has none. Hands of one player are made side by side and mostly stay so: asked at the right place
// this looks at one row or two, whatever the number of players.
inline std::size_t find_hand_row(const Column<HandOwner>& owner, Entity player, std::size_t from) {
    const std::size_t count = owner.size();
    for (std::size_t step = 0; step < count; ++step) {
        const std::size_t row = (from + step) % count;
        if (owner.rows()[row].player == player) {
            return row;
        }
    }
    return count;
}

// The row in `grab` of the same player's other hand, or its size.
inline std::size_t find_other_hand(const Column<HandOwner>& owner, const Column<Grab>& grab,
                                   std::size_t row) {
    const std::size_t own = owner.find_row(grab.owners()[row]);
    const Entity player = owner.rows()[own].player;
    // The left hand's row comes before the right one's.
    const std::size_t beside =
        owner.rows()[own].side == HandSide::left ? own + 1 : own + owner.size() - 1;
    std::size_t other = find_hand_row(owner, player, beside);
    if (other == own) {
        other = find_hand_row(owner, player, own + 1);
    }
    const std::size_t found =
        other == own ? Column<Grab>::k_npos : grab.find_row(owner.owners()[other]);
    return found == Column<Grab>::k_npos ? grab.size() : found;
}

// True where two hands of one player hold one free body, which they can turn as they like.
inline bool share_free_body(const Grab& a, const Grab& b) {
    return a.kind == GripKind::held && b.kind == GripKind::held && a.body == b.body && !a.jointed &&
           !b.jointed;
}

// True where two hands of one player hold him, or one body, together: they meet halfway where they
// cannot both have what they want, and one that is left alone starts afresh.
inline bool share_hold(const Grab& a, const Grab& b) {
    const bool both_fixed = a.kind == GripKind::surface && b.kind == GripKind::surface;
    return both_fixed || (a.kind != GripKind::none && a.kind == b.kind && a.body == b.body);
}

// Of two hands on one body the one that holds longer is the first; of two alike the left one.
inline bool is_first_hand(const Column<HandOwner>& owner, const Column<Grab>& grab, std::size_t row,
                          std::size_t other) {
    const double difference_s = grab.rows()[row].since_s - grab.rows()[other].since_s;
    return difference_s != 0.0 ? difference_s < 0.0
                               : owner.at(grab.owners()[row]).side == HandSide::left;
}

}  // namespace handhold
