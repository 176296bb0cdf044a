#pragma once

#include "game/levels/station_rack.hpp"

namespace handhold {

// The fronts that fill a whole rack: garden, bunk, bench and stowage. Between the tracks, nothing
// higher over the wall than 2 cm, so that the rails beside it stay free.
void build_fitting(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed);

}  // namespace handhold
