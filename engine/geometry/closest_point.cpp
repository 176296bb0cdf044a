#include "engine/geometry/closest_point.hpp"

#include <algorithm>

namespace handhold {
namespace {

// A triangle with an area below this times its longest edge squared counts as degenerate.
constexpr double k_no_area = 1e-13;

// Parameter in [0, 1] of the closest point on a segment.
double segment_parameter(const Vec3& point, const Vec3& from, const Vec3& direction) {
    const double squared = direction.squaredNorm();
    return squared > 0.0 ? std::clamp((point - from).dot(direction) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

Vec3 area_vector(const Corners& corners) {
    const Vec3 ab = corners[1] - corners[0];
    const Vec3 ac = corners[2] - corners[0];
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    const Vec3 area = ab.cross(ac);
    return area.norm() > k_no_area * longest ? area : Vec3(Vec3::Zero());
}

Vec3 closest_on_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
    const Vec3 direction = to - from;
    return from + segment_parameter(point, from, direction) * direction;
}

Vec3 closest_on_triangle(const Vec3& point, const Corners& corners) {
    // Returns the projection onto the plane if it is inside all three edges, else the nearest point
    // of the edges. This is slower than classifying Voronoi regions, but the choice never divides
    // by the area of a sliver.
    const Vec3 area = area_vector(corners);
    const double squared_area = area.squaredNorm();
    bool inside = squared_area > 0.0;
    for (std::size_t i = 0; inside && i < 3; ++i) {
        const Vec3 edge = corners[(i + 1) % 3] - corners[i];
        inside = edge.cross(point - corners[i]).dot(area) >= 0.0;
    }
    if (inside) {
        return point - (point - corners[0]).dot(area) / squared_area * area;
    }
    Vec3 best = closest_on_segment(point, corners[0], corners[1]);
    for (std::size_t i = 1; i < 3; ++i) {
        const Vec3 other = closest_on_segment(point, corners[i], corners[(i + 1) % 3]);
        if ((other - point).squaredNorm() < (best - point).squaredNorm()) {
            best = other;
        }
    }
    return best;
}

std::pair<Vec3, Vec3> closest_between_segments(const std::array<Vec3, 2>& a,
                                               const std::array<Vec3, 2>& b) {
    const Vec3 along_a = a[1] - a[0];
    const Vec3 along_b = b[1] - b[0];
    const double aa = along_a.squaredNorm();
    const double bb = along_b.squaredNorm();
    const double ab = along_a.dot(along_b);
    const double determinant = aa * bb - ab * ab;
    double on_a = 0.0;
    if (determinant > 1e-14 * aa * bb) {
        const Vec3 offset = b[0] - a[0];
        on_a = std::clamp((offset.dot(along_a) * bb - offset.dot(along_b) * ab) / determinant, 0.0,
                          1.0);
    }
    // Clamping once in turn is enough: first the point of b closest to a's point, then the point of
    // a closest to that point.
    const double on_b = segment_parameter(a[0] + on_a * along_a, b[0], along_b);
    const Vec3 point_b = b[0] + on_b * along_b;
    on_a = segment_parameter(point_b, a[0], along_a);
    return {a[0] + on_a * along_a, point_b};
}

}  // namespace handhold
