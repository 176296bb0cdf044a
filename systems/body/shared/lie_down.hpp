#pragma once

#include "engine/math/math.hpp"

// Estimates from the head's pose above the tracked floor whether a player lies or reclines.
namespace handhold {

// How far the trunk lies along the head's up axis: 0 upright, bent or crouching, 1 lying. A trunk
// that reclines from hips on the floor until the eyes are at eyes_m has a known tilt. A player lies
// if the eyes are low and the head is tilted by about that angle or more. On hands and knees, a
// head at that height is tilted less or looks down; a head that looks down must be lower to count
// as lying.
//
// eyes_m: height of the eyes above the tracked floor, for an eye height of k_scale_eye_m. up_ps,
// ahead_ps: axes of the head, play space.
double lying_share(double eyes_m, const Vec3& up_ps, const Vec3& ahead_ps);

}  // namespace handhold
