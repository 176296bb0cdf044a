#pragma once

#include <cstdint>

#include "game/levels/station.hpp"

// The meshes of the scene "arena".
namespace handhold {

inline constexpr Color k_blue_team = {0.06F, 0.22F, 0.85F};
inline constexpr Color k_orange_team = {0.95F, 0.30F, 0.03F};

// The hall with its holds and the goals' rings, in the world's frame. It does not move.
Structure make_arena_hall();
// A platform with rails, in its body's frame: 2.4 m x 0.3 m x 1.6 m.
Structure make_arena_platform();

inline constexpr double k_disc_radius_m = 0.15;
inline constexpr double k_disc_half_height_m = 0.022;
// The disc about Y: the body, and the glowing ring on both sides.
Structure make_arena_disc();

inline constexpr double k_drum_face_m = 1.6;  // distance of the faces from the axis
// A drum about X with the digits 0 to 9. Digit d faces +Z after a rotation by d tenths of a turn.
Structure make_score_drum(const Color& color);

}  // namespace handhold
