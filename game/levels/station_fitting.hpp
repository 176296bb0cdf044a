#pragma once

#include "game/levels/station_rack.hpp"

namespace handhold {

// Fronts that fill a whole rack: garden, bunk, bench and stowage. Between the seat tracks they rise
// at most 2 cm above the wall, which leaves the rails beside them free.
void build_fitting(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed);

}  // namespace handhold
