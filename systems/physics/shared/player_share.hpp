#pragma once

#include <algorithm>

namespace handhold {

// Least factor on a player's inverse mass against free bodies of which the heaviest has
// `heaviest_kg`; in (0, 1]. Light bodies must not shake a player of `mass_kg`, so the player counts
// as up to 1000 times as heavy as they are. A larger ratio of masses would make the solver's
// regularisation visible.
inline double least_player_share(double heaviest_kg, double mass_kg) {
    constexpr double k_times_heaviest = 1000.0;
    return mass_kg / std::max(k_times_heaviest * heaviest_kg, mass_kg);
}

}  // namespace handhold
