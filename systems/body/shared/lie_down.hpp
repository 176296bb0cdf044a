#pragma once

#include "engine/math/math.hpp"

// Players who lie or recline, as far as head and floor tell.
namespace handhold {

// How far the trunk lies along the head's up axis: 0 upright, bent or crouching, 1 lying. An
// upright trunk of any bend holds the eyes above a height that depends on the head's tilt: eyes
// that are lower, with a head that is tilted as a trunk would be that reclines to that height,
// belong to a player who lies. On hands and knees a head is tilted less, or is tilted ahead.
//
// eyes_m: height of the eyes above the tracked floor, for an eye height of k_scale_eye_m. up_ps,
// ahead_ps: axes of the head, play space.
double lying_share(double eyes_m, const Vec3& up_ps, const Vec3& ahead_ps);

}  // namespace handhold
