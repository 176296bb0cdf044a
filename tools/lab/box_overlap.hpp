#pragma once

#include "engine/math/math.hpp"

namespace handhold::lab {

// Overlap of two boxes along the axis on which it is least, m; below 0 if they are apart. By
// separating axes (the boxes' normals and the cross products of their edges), without the runtime's
// collision code.
double box_overlap_m(const Pose& a, const Vec3& half_a_m, const Pose& b, const Vec3& half_b_m);

}  // namespace handhold::lab
