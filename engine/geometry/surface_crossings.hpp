#pragma once

#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

// True if the segment crosses the surface an odd number of times, whatever its winding. Layers
// closer together than a micrometre count as one. Crossings after the 16th do not count.
bool crosses_oddly(const TriangleBvh& surface, Vec3 from, const Vec3& to);

}  // namespace handhold
