#include "engine/geometry/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/bvh_builder.hpp"

namespace handhold {
namespace {

// A segment in the frame of Woop's test: sheared so that it runs along one axis from the origin.
struct ShearedRay {
    Vec3 from;
    std::array<int, 3> axis;      // the last is that along which the ray goes farthest
    std::array<double, 3> shear;  // the last is one over the way along it
};

ShearedRay shear(const Vec3& from, const Vec3& way) {
    ShearedRay ray;
    ray.from = from;
    int along = 0;
    way.cwiseAbs().maxCoeff(&along);
    ray.axis = {(along + 1) % 3, (along + 2) % 3, along};
    ray.shear = {way[ray.axis[0]] / way[along], way[ray.axis[1]] / way[along], 1.0 / way[along]};
    return ray;
}

// Fraction of the way at which the ray meets the triangle; a negative number where it does not.
// Edge functions of two triangles on one edge are equal but for the sign, so one of them is hit.
double meet_fraction(const ShearedRay& ray, const Corners& corners) {
    std::array<std::array<double, 3>, 3> p;  // the corners in the ray's frame
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 offset = corners[i] - ray.from;
        const double z = offset[ray.axis[2]];
        p[i] = {offset[ray.axis[0]] - ray.shear[0] * z, offset[ray.axis[1]] - ray.shear[1] * z,
                ray.shear[2] * z};
    }
    const double u = p[2][0] * p[1][1] - p[2][1] * p[1][0];
    const double v = p[0][0] * p[2][1] - p[0][1] * p[2][0];
    const double w = p[1][0] * p[0][1] - p[1][1] * p[0][0];
    const bool one_side = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    const double sum = u + v + w;
    if (!one_side || sum == 0.0) {
        return -1.0;
    }
    // Shares first: a sliver's sum may be so small that one over it is infinite.
    const double fraction = (u / sum) * p[0][2] + (v / sum) * p[1][2] + (w / sum) * p[2][2];
    return fraction >= 0.0 && fraction <= 1.0 ? fraction : -1.0;
}

double bounded_inverse(double x) {
    constexpr double k_huge = 1e290;  // finite, so that no product with zero is a NaN
    const double inverse = 1.0 / x;
    return std::abs(inverse) <= k_huge ? inverse : std::copysign(k_huge, inverse);
}

// No more than the triangle's distance from the point, squared, but for rounding: that of a box
// around it.
double box_squared(const Vec3& point, const Corners& corners) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}
constexpr double k_bound_slack = 1.0 + 1e-12;

}  // namespace

TriangleBvh::TriangleBvh(std::span<const Vec3> positions,
                         std::span<const std::array<std::uint32_t, 3>> triangles) {
    BvhBuilder(*this, positions, triangles).build();
}

std::size_t TriangleBvh::memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + positions_.capacity() * sizeof(Vec3) +
           slots_.capacity() * sizeof(slots_[0]) + numbers_.capacity() * sizeof(numbers_[0]);
}

bool TriangleBvh::meets_sphere(std::uint32_t slot, const Vec3& center,
                               double squared_radius) const {
    const Corners triangle = corners(slot);
    for (const Vec3& corner : triangle) {
        if ((corner - center).squaredNorm() <= squared_radius) {
            return true;
        }
    }
    return box_squared(center, triangle) <= squared_radius * k_bound_slack &&
           (closest_on_triangle(center, triangle) - center).squaredNorm() <= squared_radius;
}

std::optional<TriangleHit> TriangleBvh::cast_ray(const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from;
    if (nodes_.empty() || !is_finite(from) || !is_finite(way) || way.isZero(0.0)) {
        return std::nullopt;
    }
    const ShearedRay ray = shear(from, way);
    const Vec3 start = from - origin_;
    const Vec3 inverse(bounded_inverse(way.x()), bounded_inverse(way.y()),
                       bounded_inverse(way.z()));
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t best_number = 0;
    // Where the ray enters the box, as a fraction; infinity where it does not before `best`.
    const auto entry = [&](const Node& node) -> double {
        double enter = 0.0;
        double leave = std::min(1.0, best);
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double a = (static_cast<double>(node.low[i]) - start[axis]) * inverse[axis];
            const double b = (static_cast<double>(node.high[i]) - start[axis]) * inverse[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave ? enter : std::numeric_limits<double>::infinity();
    };
    struct Open {
        std::uint32_t node;
        double entry;
    };
    std::array<Open, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    stack[depth++] = {0, entry(nodes_[0])};
    while (depth > 0) {
        const Open open = stack[--depth];
        if (!(open.entry <= std::min(1.0, best))) {
            continue;
        }
        const Node& node = nodes_[open.node];
        if (node.count == 0) {
            Open near = {node.first, entry(nodes_[node.first])};
            Open far = {node.first + 1, entry(nodes_[node.first + 1])};
            if (far.entry < near.entry) {
                std::swap(near, far);
            }
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
            const double fraction = meet_fraction(ray, corners(slot));
            if (fraction >= 0.0 &&
                (fraction < best || (fraction == best && numbers_[slot] < best_number))) {
                best = fraction;
                best_number = numbers_[slot];
            }
        }
    }
    if (!(best <= 1.0)) {
        return std::nullopt;
    }
    return TriangleHit{best_number, from + best * way, best * way.norm()};
}

std::optional<TriangleHit> TriangleBvh::closest_point(const Vec3& point,
                                                      double max_distance_m) const {
    if (nodes_.empty() || !is_finite(point) || !(max_distance_m >= 0.0)) {
        return std::nullopt;
    }
    const Vec3 local = point - origin_;
    double best = max_distance_m * max_distance_m;
    TriangleHit hit;
    bool found = false;
    struct Open {
        std::uint32_t node;
        double squared_distance;
    };
    std::array<Open, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    stack[depth++] = {0, squared_distance(nodes_[0], local)};
    while (depth > 0) {
        const Open open = stack[--depth];
        if (!(open.squared_distance <= best)) {
            continue;
        }
        const Node& node = nodes_[open.node];
        if (node.count == 0) {
            Open near = {node.first, squared_distance(nodes_[node.first], local)};
            Open far = {node.first + 1, squared_distance(nodes_[node.first + 1], local)};
            if (far.squared_distance < near.squared_distance) {
                std::swap(near, far);
            }
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
            const Corners triangle = corners(slot);
            if (box_squared(point, triangle) > best * k_bound_slack) {
                continue;
            }
            const Vec3 on_triangle = closest_on_triangle(point, triangle);
            const double squared = (on_triangle - point).squaredNorm();
            if (squared < best || (squared == best && (!found || numbers_[slot] < hit.triangle))) {
                best = squared;
                hit = {numbers_[slot], on_triangle, 0.0};
                found = true;
            }
        }
    }
    if (!found) {
        return std::nullopt;
    }
    hit.distance_m = std::sqrt(best);
    return hit;
}

}  // namespace handhold
