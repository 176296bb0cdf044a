#include "engine/io/triangle_list.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace handhold {

namespace {

// True if the triangle's height is above 1e-10 of its longest edge. Rounding gives three collinear
// points a smaller height; the thinnest triangles of levels are orders of magnitude higher.
bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double k_min_height_ratio = 1e-10;
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
    return (b - a).cross(c - a).norm() > k_min_height_ratio * longest2;
}

// Positions of triangle i's corners in the list of indices. Every second triangle of a strip is
// reversed so that all face the same side. The hub of a fan comes last.
std::array<std::size_t, 3> corner_offsets(TriangleMode mode, std::size_t i) {
    switch (mode) {
        case TriangleMode::strip:
            return {i, i + 1 + i % 2, i + 2 - i % 2};
        case TriangleMode::fan:
            return {i + 1, i + 2, 0};
        case TriangleMode::list:
            break;
    }
    return {3 * i, 3 * i + 1, 3 * i + 2};
}

}  // namespace

std::size_t count_triangles(TriangleMode mode, std::size_t corners) {
    if (mode == TriangleMode::list) {
        return corners % 3 == 0 ? corners / 3 : 0;
    }
    return corners < 3 ? 0 : corners - 2;
}

std::size_t append_triangles(TriangleMode mode, Winding winding,
                             std::span<const std::uint32_t> indices, std::uint32_t first,
                             Mesh& mesh) {
    const std::size_t count = count_triangles(mode, indices.size());
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<std::size_t, 3> offset = corner_offsets(mode, i);
        std::array<std::uint32_t, 3> triangle = {
            first + indices[offset[0]], first + indices[offset[1]], first + indices[offset[2]]};
        if (!has_area(mesh.positions[triangle[0]], mesh.positions[triangle[1]],
                      mesh.positions[triangle[2]])) {
            ++dropped;
            continue;
        }
        if (winding == Winding::reversed) {
            std::swap(triangle[1], triangle[2]);
        }
        mesh.triangles.push_back(triangle);
    }
    return dropped;
}

}  // namespace handhold
