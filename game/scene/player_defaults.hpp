#pragma once

// Defaults for players where neither the scene nor the command line says otherwise.
namespace handhold {

inline constexpr double k_eye_height_m = 1.6;  // of a player who stands in play space
inline constexpr double k_jets_mps2 = 0.5;     // for scenes without thrusters that need some
inline constexpr double k_pull_reach_m =
    3.0;  // for scenes without distance grab when it is switched on
inline constexpr double k_head_clear_m =
    0.3;  // comfortable distance from a head's centre to surfaces

}  // namespace handhold
