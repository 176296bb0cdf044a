#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

// An indexed triangle soup in its own frame, metres. Meant to be counter-clockwise from outside,
// but real levels have mixed winding.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // every index < positions.size()
    std::array<float, 3> color = {0.6F, 0.6F, 0.62F};     // linear RGB, for pictures only
};

}  // namespace handhold
