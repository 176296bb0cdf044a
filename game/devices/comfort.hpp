#pragma once

#include <algorithm>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

namespace handhold {

// Strength of the vignette (darkened edges of the view), [0, strength]. Follows the player's speed
// relative to the reference velocity: none below 1 m/s, full from 4 m/s on.
inline double vignette_of(const hh::World& world, hh::Player player, double strength) {
    constexpr double k_calm_mps = 1.0;
    constexpr double k_fast_mps = 4.0;
    const double speed_mps =
        hh::length(world.pose(player)->velocity_mps - *world.reference_velocity_mps(player));
    return strength * std::clamp((speed_mps - k_calm_mps) / (k_fast_mps - k_calm_mps), 0.0, 1.0);
}

}  // namespace handhold
