#pragma once

#include "game/levels/station_rack.hpp"

namespace handhold {

// Adds a front that fills a whole rack: `kind` is garden, bunk, bench or stowage. Between the
// wall's two seat tracks it rises at most 2 cm, which keeps the handrails on the tracks free.
void build_fitting(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed);

}  // namespace handhold
