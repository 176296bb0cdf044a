#pragma once

#include "game/levels/station_description.hpp"
#include "game/levels/station_kit.hpp"

namespace handhold {

inline constexpr double k_truss_bay_m = 1.0;
inline constexpr double k_truss_strip_m = 0.47;  // height of the strips' faces above the axis

// Builds a lattice of square bays from z = 0 along +Z, with solar wings at both ends, radiators, a
// dish, and boxes and tanks in its bays. `pose`: the section's frame in the station.
void build_truss(Structure& out, const StationSection& section, const Pose& pose);

}  // namespace handhold
