#pragma once

#include <array>

#include "engine/math/float4.hpp"

// Four of a kind side by side, in floats: for what only has to tell far from near.
namespace handhold {

// Upright boxes, by coordinate.
struct FourBoxes {
    std::array<FourFloats, 3> low = {};
    std::array<FourFloats, 3> high = {};
};

struct FourTriangles {
    FourCorners corner = {};
    std::array<FourFloats, 3> normal = {};  // by coordinate: unit, or zero where there is none
};

}  // namespace handhold
