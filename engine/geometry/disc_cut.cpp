#include "engine/geometry/disc_cut.hpp"

#include <algorithm>

#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

Vec3 crossing(const Vec3& a, double height_a, const Vec3& b, double height_b) {
    return a + height_a / (height_a - height_b) * (b - a);
}

}  // namespace

double height_over(const Disc& disc, const Vec3& point) {
    return disc.normal.dot(point - disc.center);
}

double distance_to_origin(const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
    return (a + t * along).norm();
}

std::array<double, 3> corner_heights(const SurfaceGraph& graph, const Disc& disc,
                                     std::uint32_t triangle) {
    const auto& corners = graph.triangles[triangle];
    return {height_over(disc, graph.positions[corners[0]]),
            height_over(disc, graph.positions[corners[1]]),
            height_over(disc, graph.positions[corners[2]])};
}

std::optional<TriangleCut> cut_triangle(const SurfaceGraph& graph, const Disc& disc,
                                        std::uint32_t triangle) {
    const std::array<double, 3> heights = corner_heights(graph, disc, triangle);
    const auto& corners = graph.triangles[triangle];
    TriangleCut cut;
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t j = (i + 1) % 3;
        if ((heights[i] >= 0.0) != (heights[j] >= 0.0)) {
            // Always computed from the lower to the higher vertex, so that neighbours get bitwise
            // the same point on their common edge.
            const bool forward = corners[i] < corners[j];
            const std::uint32_t a = forward ? i : j;
            const std::uint32_t b = forward ? j : i;
            cut.edge[found] = i;
            cut.point[found++] = crossing(graph.positions[corners[a]], heights[a],
                                          graph.positions[corners[b]], heights[b]);
        }
    }
    return found == 2 ? std::optional<TriangleCut>(cut) : std::nullopt;
}

bool reaches_disc(const Disc& disc, const TriangleCut& cut) {
    return distance_to_origin(to_disc(disc, cut.point[0]), to_disc(disc, cut.point[1])) <=
           disc.radius_m;
}

bool is_edge_in_reach(const SurfaceGraph& graph, const Disc& disc, std::uint32_t triangle,
                      std::uint32_t edge) {
    const auto& corners = graph.triangles[triangle];
    const double far_m = disc.radius_m + k_prune_m;
    const Vec3 nearest = closest_on_segment(disc.center, graph.positions[corners[edge]],
                                            graph.positions[corners[(edge + 1) % 3]]);
    return (nearest - disc.center).squaredNorm() <= far_m * far_m;
}

}  // namespace handhold
