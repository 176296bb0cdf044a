#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

// Collapses edges, cheapest quadric error first (Garland and Heckbert 1997; meshoptimizer), until
// the next collapse would cost more than error_m or leave fewer than least_triangles. The error is
// an average over the triangles merged into a vertex, so single points may deviate more: see
// surface_distance.hpp. Borders are preserved. Points in `locked` stay corners; they may have any
// order but no duplicates. Precondition: finite points, indices in range.
struct SimplifyInput {
    std::span<const Vec3> positions;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const std::uint32_t> locked;  // point indices
};
std::vector<std::array<std::uint32_t, 3>> simplify(const SimplifyInput& input, double error_m,
                                                   std::size_t least_triangles);

}  // namespace handhold
