#include "engine/geometry/convex_hull.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "engine/geometry/hull_builder.hpp"

namespace handhold {
namespace {

bool corner_less(const Vec3& a, const Vec3& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

// Sorts the points and removes duplicates, so that the result does not depend on the input's order.
// -0.0 becomes 0.0, which it equals: which of two such duplicates is kept has no effect then.
std::vector<Vec3> sorted(std::span<const Vec3> points) {
    std::vector<Vec3> result;
    result.reserve(points.size());
    for (const Vec3& point : points) {
        result.emplace_back(point.array() + 0.0);
    }
    std::sort(result.begin(), result.end(), corner_less);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

double extent_along(const ConvexHull& hull, const Vec3& direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& corner : hull.corners) {
        low = std::min(low, direction.dot(corner));
        high = std::max(high, direction.dot(corner));
    }
    return high - low;
}

// The minimum width is attained across a face or across two edges (Houle and Toussaint, Computing
// the Width of a Set, 1988).
double width_of(const ConvexHull& hull) {
    std::vector<Vec3> edges;
    double min_m = std::numeric_limits<double>::infinity();
    for (const HullFace& face : hull.faces) {
        min_m = std::min(min_m, extent_along(hull, face.normal));
        for (std::size_t i = 0; i < face.loop.size(); ++i) {
            const std::uint32_t from = face.loop[i];
            const std::uint32_t to = face.loop[(i + 1) % face.loop.size()];
            if (from < to) {  // lists each edge once, although two faces share it
                edges.push_back((hull.corners[to] - hull.corners[from]).normalized());
            }
        }
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 across = edges[i].cross(edges[j]);
            if (across.norm() > 1e-6) {
                min_m = std::min(min_m, extent_along(hull, across.normalized()));
            }
        }
    }
    return min_m;
}

}  // namespace

std::optional<ConvexHull> make_convex_hull(std::span<const Vec3> points) {
    const bool finite = std::all_of(points.begin(), points.end(), is_finite);
    if (points.size() < 4 || !finite) {
        return std::nullopt;
    }
    std::optional<ConvexHull> hull = HullBuilder(sorted(points)).build();
    if (hull) {
        hull->width_m = width_of(*hull);
    }
    return hull;
}

ConvexHull moved_hull(const ConvexHull& hull, const Pose& pose) {
    ConvexHull moved = hull;
    for (Vec3& corner : moved.corners) {
        corner = transform_point(pose, corner);
    }
    for (HullFace& face : moved.faces) {
        face.normal = (pose.rotation * face.normal).normalized();
        face.offset_m = -std::numeric_limits<double>::infinity();
        for (const Vec3& corner : moved.corners) {
            face.offset_m = std::max(face.offset_m, face.normal.dot(corner));
        }
    }
    return moved;
}

}  // namespace handhold
