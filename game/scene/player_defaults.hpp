#pragma once

// Defaults for players where neither the scene nor the command line says otherwise.
namespace handhold {

inline constexpr double k_eye_height_m = 1.6;  // eye height of a player who stands in play space
inline constexpr double k_jets_mps2 = 0.5;     // default for scenes without jets that need some
// Reach of the distance grab if it is switched on for a scene without one.
inline constexpr double k_pull_reach_m = 3.0;
// Comfortable distance between a head's centre and surfaces.
inline constexpr double k_head_clear_m = 0.3;

}  // namespace handhold
