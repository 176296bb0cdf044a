#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// A bone of length 1 from the origin whose end is to stay before a surface: the unit direction
// nearest to `towards` with normal . direction >= least, by the least turn, but at most `most` (of
// the bone's length) farther out than `towards` is. Where nothing reaches that far: straight out.
// `towards` and `normal` are unit.
Vec3 deflect_outward(const Vec3& towards, const Vec3& normal, double least, double most);

}  // namespace handhold
