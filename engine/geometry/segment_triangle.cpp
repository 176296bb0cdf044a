#include "engine/geometry/segment_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace handhold {
namespace {

// Where the segment passes through the triangle's inside.
std::optional<Vec3> find_passage(const std::array<Vec3, 2>& segment, const Corners& triangle) {
    const Vec3 area = area_vector(triangle);
    const double height_a = area.dot(segment[0] - triangle[0]);
    const double height_b = area.dot(segment[1] - triangle[0]);
    if ((height_a > 0.0) == (height_b > 0.0) || height_a == height_b) {
        return std::nullopt;
    }
    const Vec3 point = segment[0] + height_a / (height_a - height_b) * (segment[1] - segment[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& corner = triangle[i];
        if (area.dot((triangle[(i + 1) % 3] - corner).cross(point - corner)) < 0.0) {
            return std::nullopt;
        }
    }
    return point;
}

}  // namespace

SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle) {
    if (const std::optional<Vec3> passage = find_passage(segment, triangle)) {
        return {*passage, *passage, 0.0};
    }
    SegmentTriangle best;
    best.distance_m = std::numeric_limits<double>::infinity();
    const auto take = [&best](const Vec3& on_segment, const Vec3& on_triangle) {
        const double distance_m = (on_segment - on_triangle).norm();
        if (distance_m < best.distance_m) {
            best = {on_segment, on_triangle, distance_m};
        }
    };
    for (const Vec3& end : segment) {
        take(end, closest_on_triangle(end, triangle));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [on_segment, on_edge] =
            closest_between_segments(segment, {triangle[i], triangle[(i + 1) % 3]});
        take(on_segment, on_edge);
    }
    return best;
}

double least_distance(const std::array<Vec3, 2>& segment, const Corners& triangle) {
    double squared = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax(segment[0][axis], segment[1][axis]);
        const auto [least, most] =
            std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        const double gap = std::max({least - high, low - most, 0.0});
        squared += gap * gap;
    }
    return std::sqrt(squared);
}

}  // namespace handhold
