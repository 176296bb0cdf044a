#pragma once

#include <cstddef>
#include <cstdint>

#include "game/levels/station_kit.hpp"

namespace handhold {

// Half the width of a wall between its two corner stand-offs, and half its clear height from the
// module's axis.
inline constexpr double k_wall_half_m = 0.80;
inline constexpr double k_clear_half_m = 1.10;
inline constexpr double k_rack_pitch_m = 1.05;
// Across the wall, where its two seat tracks run: the handrails stand on them.
inline constexpr double k_track_m = 0.56;

// What a rack's front is: drawers and grilles to stand on; drawers, screens, bags, dials and vents;
// lamps; nothing but bags under nets; plants; a place to sleep; a glove box and screens.
enum class RackKind : std::uint8_t { deck, equipment, lights, stowage, garden, bunk, bench };

// The middle of a front, between the two tracks.
inline constexpr double k_bay_half_m = 0.47;

// One rack's length of one wall, from z0 to z0 + k_rack_pitch_m in `frame` (y = 0 the wall's face,
// X across it): frames, two seat tracks, and a front whose details are chosen by `seed`.
void build_rack(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed);

}  // namespace handhold
