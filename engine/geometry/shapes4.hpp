#pragma once

#include <array>

#include "engine/math/float4.hpp"

// Four boxes or triangles side by side in floats, for conservative rejection tests.
namespace handhold {

// Axis-aligned boxes, by coordinate.
struct Boxes4 {
    std::array<Float4, 3> low = {};
    std::array<Float4, 3> high = {};
};

struct Triangles4 {
    Corners4 corner = {};
    std::array<Float4, 3> normal = {};  // by coordinate: unit, or zero if degenerate
};

}  // namespace handhold
