#include "engine/geometry/segment_triangle.hpp"

#include <cmath>
#include <limits>

namespace handhold {
namespace {

// A triangle's plane, and the planes through its edges that are parallel to the normal.
class Prism {
  public:
    Prism(const Corners& triangle, const Vec3& normal) : triangle_(triangle), normal_(normal) {
        for (std::size_t i = 0; i < 3; ++i) {
            inward_[i] = normal.cross(triangle[(i + 1) % 3] - triangle[i]);
        }
    }

    double height(const Vec3& point) const { return normal_.dot(point - triangle_[0]); }
    bool is_over(const Vec3& point) const {
        return inward_[0].dot(point - triangle_[0]) >= 0.0 &&
               inward_[1].dot(point - triangle_[1]) >= 0.0 &&
               inward_[2].dot(point - triangle_[2]) >= 0.0;
    }

  private:
    const Corners& triangle_;
    const Vec3& normal_;
    std::array<Vec3, 3> inward_;
};

}  // namespace

SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle) {
    return nearest_between(segment, triangle, area_vector(triangle));
}

// The nearest points are a crossing, an end of the segment with its projection into the triangle,
// or points of the segment and an edge.
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle,
                                const Vec3& normal) {
    const double squared_normal = normal.squaredNorm();
    const Prism prism(triangle, normal);
    const std::array<double, 2> height = {prism.height(segment[0]), prism.height(segment[1])};
    if ((height[0] > 0.0) != (height[1] > 0.0) && height[0] != height[1]) {
        const Vec3 crossing =
            segment[0] + height[0] / (height[0] - height[1]) * (segment[1] - segment[0]);
        if (prism.is_over(crossing)) {
            return {crossing, crossing, 0.0};
        }
    }
    SegmentTriangle best;
    double min_squared = std::numeric_limits<double>::infinity();
    const auto take = [&](const Vec3& on_segment, const Vec3& on_triangle) {
        const double squared = (on_segment - on_triangle).squaredNorm();
        if (squared < min_squared) {
            min_squared = squared;
            best.on_segment = on_segment;
            best.on_triangle = on_triangle;
        }
    };
    for (std::size_t i = 0; i < 2; ++i) {
        if (squared_normal > 0.0 && prism.is_over(segment[i])) {
            take(segment[i], segment[i] - height[i] / squared_normal * normal);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [on_segment, on_edge] =
            closest_between_segments(segment, {triangle[i], triangle[(i + 1) % 3]});
        take(on_segment, on_edge);
    }
    best.distance_m = std::sqrt(min_squared);
    return best;
}

}  // namespace handhold
