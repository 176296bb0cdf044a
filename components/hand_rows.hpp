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

}  // namespace handhold
