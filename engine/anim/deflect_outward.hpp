#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Turns a bone away from a surface. Returns the unit direction nearest to `towards` with
// dot(normal, direction) >= min_out, but raises dot(normal, direction) by at most max_lift. Returns
// `normal` if that bound is 1 or more, and `towards` if it is opposite to `normal`. `towards` and
// `normal` are unit vectors.
Vec3 deflect_outward(const Vec3& towards, const Vec3& normal, double min_out, double max_lift);

}  // namespace handhold
