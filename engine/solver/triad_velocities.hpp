#pragma once

#include "engine/solver/island_view.hpp"
#include "engine/solver/triad_system.hpp"
#include "engine/solver/velocities.hpp"

namespace handhold {

// solve_velocities for the island that `triads` has loaded.
void solve_triad_velocities(const IslandView& island, const VelocitySettings& settings,
                            TriadSystem& triads);

}  // namespace handhold
