#include "engine/geometry/segment_triangle.hpp"

#include <cmath>
#include <limits>

namespace handhold {
namespace {

// A triangle's plane, and the planes that stand on its edges.
class Prism {
  public:
    Prism(const Corners& triangle, const Vec3& normal) : triangle_(triangle), normal_(normal) {
        for (std::size_t i = 0; i < 3; ++i) {
            inward_[i] = normal.cross(triangle[(i + 1) % 3] - triangle[i]);
        }
    }

    double height(const Vec3& point) const { return normal_.dot(point - triangle_[0]); }
    bool holds(const Vec3& point) const {
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

// Of a passage, of an end over the triangle's inside, and of the edges, one is the nearest.
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle,
                                const Vec3& normal) {
    const double squared_normal = normal.squaredNorm();
    const Prism prism(triangle, normal);
    const std::array<double, 2> height = {prism.height(segment[0]), prism.height(segment[1])};
    if ((height[0] > 0.0) != (height[1] > 0.0) && height[0] != height[1]) {
        const Vec3 passage =
            segment[0] + height[0] / (height[0] - height[1]) * (segment[1] - segment[0]);
        if (prism.holds(passage)) {
            return {passage, passage, 0.0};
        }
    }
    SegmentTriangle best;
    double least = std::numeric_limits<double>::infinity();
    const auto take = [&](const Vec3& on_segment, const Vec3& on_triangle) {
        const double squared = (on_segment - on_triangle).squaredNorm();
        if (squared < least) {
            least = squared;
            best.on_segment = on_segment;
            best.on_triangle = on_triangle;
        }
    };
    for (std::size_t i = 0; i < 2; ++i) {
        if (squared_normal > 0.0 && prism.holds(segment[i])) {
            take(segment[i], segment[i] - height[i] / squared_normal * normal);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [on_segment, on_edge] =
            closest_between_segments(segment, {triangle[i], triangle[(i + 1) % 3]});
        take(on_segment, on_edge);
    }
    best.distance_m = std::sqrt(least);
    return best;
}

}  // namespace handhold
