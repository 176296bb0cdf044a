#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

// A triangle soup with indices, in its own frame, metres. Triangles should be counter-clockwise
// seen from outside, but levels often have mixed winding.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // every index < positions.size()
    std::array<float, 3> color = {0.6F, 0.6F, 0.62F};     // linear RGB, for pictures only
};

}  // namespace handhold
