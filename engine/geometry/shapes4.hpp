#pragma once

#include <array>

#include "engine/math/float4.hpp"

// Four of a kind side by side, in floats: for what only has to tell far from near.
namespace handhold {

// Upright boxes, by coordinate.
struct Boxes4 {
    std::array<Float4, 3> low = {};
    std::array<Float4, 3> high = {};
};

struct Triangles4 {
    Corners4 corner = {};
    std::array<Float4, 3> normal = {};  // by coordinate: unit, or zero where there is none
};

}  // namespace handhold
