#pragma once

#include "engine/math/math.hpp"

namespace handhold::lab {

// Overlap of two boxes along the axis of least overlap, m; negative if the boxes are apart. Uses
// the separating axis theorem (the boxes' normals and the cross products of their edges), and none
// of the runtime's collision code.
double box_overlap_m(const Pose& a, const Vec3& half_a_m, const Pose& b, const Vec3& half_b_m);

}  // namespace handhold::lab
