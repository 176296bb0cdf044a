#pragma once

// What the game takes its players to be, where nothing says otherwise.
namespace handhold {

inline constexpr double k_eye_height_m = 1.6;  // of who stands in play space
inline constexpr double k_jets_mps2 = 0.5;     // where a scene has no thrusters and needs some
inline constexpr double k_pull_reach_m = 3.0;  // where a scene has no distance grab and is to
inline constexpr double k_head_clear_m = 0.3;  // of a head's centre from surfaces, for ease

}  // namespace handhold
