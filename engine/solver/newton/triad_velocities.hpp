// Solver, newton: velocity solve of an island in packed triads.

#pragma once

#include "engine/solver/model/island_view.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "engine/solver/packed/triad_system.hpp"

namespace handhold {

// solve_island_velocities for the island that `triads` has loaded.
void solve_triad_velocities(const IslandView& island, const VelocitySettings& settings,
                            TriadSystem& triads);

}  // namespace handhold
