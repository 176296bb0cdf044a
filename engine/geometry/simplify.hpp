#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

// Fewer triangles over some of the same points: edges collapse, cheapest first by the quadric error
// (Garland and Heckbert, 1997; meshoptimizer), until the next would cost more than error_m or
// fewer than least_triangles would be left. The error is an estimate, an average over the triangles
// that a point stands for: points lie farther off, see surface_distance.hpp. Borders stay borders,
// and points that are `locked` (all, in any order; none twice) stay corners. Points are finite and
// indices in range.
struct SimplifyInput {
    std::span<const Vec3> positions;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const std::uint32_t> locked;  // points
};
std::vector<std::array<std::uint32_t, 3>> simplify(const SimplifyInput& input, double error_m,
                                                   std::size_t least_triangles);

}  // namespace handhold
