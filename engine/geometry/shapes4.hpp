#pragma once

#include <array>

#include "engine/math/float4.hpp"

// Four boxes or triangles in floats, one per SIMD lane, for conservative rejection tests.
namespace handhold {

// Four axis-aligned boxes: [coordinate][box].
struct Boxes4 {
    std::array<Float4, 3> low = {};
    std::array<Float4, 3> high = {};
};

struct Triangles4 {
    Corners4 corner = {};
    std::array<Float4, 3> normal = {};  // [coordinate][triangle]; unit, or zero if degenerate
};

}  // namespace handhold
