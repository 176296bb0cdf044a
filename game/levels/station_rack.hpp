#pragma once

#include <cstddef>
#include <cstdint>

#include "game/levels/station_kit.hpp"

namespace handhold {

// Half the width of a wall between its corner stand-offs, and its distance from the module's axis.
inline constexpr double k_wall_half_m = 0.80;
inline constexpr double k_clear_half_m = 1.10;
inline constexpr double k_rack_pitch_m = 1.05;
// Distance of a wall's two seat tracks from its middle; the handrails stand on them.
inline constexpr double k_track_m = 0.56;

// The content of a rack's front. deck: drawers and grilles to stand on. equipment: drawers,
// screens, bags, dials and vents. lights: lamps. stowage: bags under nets. garden: plants. bunk: a
// place to sleep. bench: a glove box and screens.
enum class RackKind : std::uint8_t { deck, equipment, lights, stowage, garden, bunk, bench };

// Half the width of a rack's front, which lies between the two tracks.
inline constexpr double k_bay_half_m = 0.47;

// One rack of one wall, from z0 to z0 + k_rack_pitch_m in `frame` (y = 0 is the wall's face, X is
// across it): frames, two seat tracks, and a front whose details depend on `seed`.
void build_rack(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed);

}  // namespace handhold
