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

// No more than the distances of boxes and triangles from a point, squared; in floats.
class LeastDistance {
  public:
    // `point` about the tree's origin; no corner is beyond `reach_m`.
    LeastDistance(const Vec3& point, double reach_m) {
        constexpr double k_rounding = 0x1p-20;  // more than ten roundings
        for (std::size_t i = 0; i < 3; ++i) {
            point_[i] = four_times(point[static_cast<Eigen::Index>(i)]);
            flat_[i] = point_[i][0];
        }
        spare_ = four_times(k_rounding * (reach_m + point.norm()));
    }

    float squared(const std::array<float, 3>& low, const std::array<float, 3>& high) const {
        const FourFloats zero = {};
        const FourFloats below = FourFloats{low[0], low[1], low[2], 0.0F} - flat_;
        const FourFloats above = flat_ - FourFloats{high[0], high[1], high[2], 0.0F};
        const FourFloats gap = higher(higher(below, above) - spare_, zero);
        const FourFloats square = gap * gap;
        return square[0] + square[1] + square[2];
    }

    // Above a triangle's plane, and from there, in the plane, to a box around the triangle.
    FourFloats squared(const FourTriangles& four) const {
        const FourFloats zero = {};
        std::array<FourFloats, 3> low;
        std::array<FourFloats, 3> high;
        FourFloats height = zero;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats a = four.corner[0][i] - point_[i];
            const FourFloats b = four.corner[1][i] - point_[i];
            const FourFloats c = four.corner[2][i] - point_[i];
            low[i] = lower(lower(a, b), c);
            high[i] = higher(higher(a, b), c);
            height += four.normal[i] * a;
        }
        const FourFloats clear = higher(higher(height, -height) - spare_, zero);
        FourFloats sum = clear * clear;
        for (std::size_t i = 0; i < 3; ++i) {
            const FourFloats foot = height * four.normal[i];
            const FourFloats gap = higher(higher(low[i] - foot, foot - high[i]) - spare_, zero);
            sum += gap * gap;
        }
        return sum;
    }

  private:
    std::array<FourFloats, 3> point_ = {};  // each coordinate four times
    FourFloats flat_ = {};                  // the three, and 0
    FourFloats spare_ = {};
};

// Normals of what looks towards a side, as long as twice the triangles' areas.
class TowardsSide {
  public:
    TowardsSide(const Vec3& side, double most_m2)
        : side_{four_times(side.x()), four_times(side.y()), four_times(side.z())},
          most_(four_times(most_m2)) {}

    // Of the first `count` of four, those that are wanted.
    Vec3 areas_of(const FourTriangles& four, const FourInts& is_wanted, std::uint32_t count) const {
        const FourFloats zero = {};
        std::array<FourFloats, 3> b;
        std::array<FourFloats, 3> c;
        for (std::size_t i = 0; i < 3; ++i) {
            b[i] = four.corner[1][i] - four.corner[0][i];
            c[i] = four.corner[2][i] - four.corner[0][i];
        }
        const FourFloats size = (b[1] * c[2] - b[2] * c[1]) * four.normal[0] +
                                (b[2] * c[0] - b[0] * c[2]) * four.normal[1] +
                                (b[0] * c[1] - b[1] * c[0]) * four.normal[2];
        const FourFloats facing =
            side_[0] * four.normal[0] + side_[1] * four.normal[1] + side_[2] * four.normal[2];
        const FourInts counts = is_wanted & (facing > zero);
        const FourFloats area = counts ? lower(higher(size, zero), most_) : zero;
        Vec3 sum = Vec3::Zero();
        for (std::uint32_t i = 0; i < count; ++i) {
            sum += static_cast<double>(area[i]) * Vec3(static_cast<double>(four.normal[0][i]),
                                                       static_cast<double>(four.normal[1][i]),
                                                       static_cast<double>(four.normal[2][i]));
        }
        return sum;
    }

  private:
    std::array<FourFloats, 3> side_;
    FourFloats most_;
};

// No more than the triangle's distance from the point, squared, but for rounding: that of a box
// around it.
double box_squared(const Vec3& point, const Corners& corners) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}
constexpr double k_bound_slack = 1.0 + 1e-5;  // floats round off less

}  // namespace

TriangleBvh::TriangleBvh(std::span<const Vec3> positions,
                         std::span<const std::array<std::uint32_t, 3>> triangles) {
    BvhBuilder(*this, positions, triangles).build();
}

std::size_t TriangleBvh::memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + positions_.capacity() * sizeof(Vec3) +
           slots_.capacity() * sizeof(slots_[0]) + numbers_.capacity() * sizeof(numbers_[0]) +
           fours_.capacity() * sizeof(fours_[0]);
}

double TriangleBvh::reach_m() const {
    float most = 0.0F;
    for (std::size_t i = 0; i < 3 && !nodes_.empty(); ++i) {
        most = std::max({most, nodes_[0].high[i], -nodes_[0].low[i]});
    }
    return static_cast<double>(most);
}

Vec3 TriangleBvh::areas_in_sphere(const Vec3& center, double radius_m, const Vec3& side,
                                  double most_m2) const {
    Vec3 sum = Vec3::Zero();
    if (nodes_.empty() || !is_finite(center) || !(radius_m >= 0.0)) {
        return sum;
    }
    const Vec3 local = center - origin_;
    const LeastDistance least(local, reach_m());
    const auto most = static_cast<float>(radius_m * radius_m);
    const TowardsSide towards(side, most_m2);
    std::array<std::uint32_t, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (least.squared(node.low, node.high) > most) {
            continue;
        }
        if (node.count == 0) {
            stack[depth++] = node.first + 1;
            stack[depth++] = node.first;
            continue;
        }
        const FourTriangles& four = fours_[node.first / 4];
        sum += towards.areas_of(four, least.squared(four) <= four_times(radius_m * radius_m),
                                node.count);
    }
    return sum;
}

bool TriangleBvh::meets_sphere(std::uint32_t slot, const Vec3& center,
                               double squared_radius) const {
    const Corners triangle = corners_at(slot);
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
            const double fraction = meet_fraction(ray, corners_at(slot));
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
    const LeastDistance least(local, reach_m());
    double best = max_distance_m * max_distance_m;
    TriangleHit hit;
    bool found = false;
    const auto limit = [&]() -> float { return static_cast<float>(best * k_bound_slack); };
    float most = limit();
    struct Open {
        std::uint32_t node;
        float least;
    };
    const auto open_node = [&](std::uint32_t node) -> Open {
        return {node, least.squared(nodes_[node].low, nodes_[node].high)};
    };
    std::array<Open, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    stack[depth++] = open_node(0);
    while (depth > 0) {
        const Open open = stack[--depth];
        if (open.least > most) {
            continue;
        }
        const Node& node = nodes_[open.node];
        if (node.count == 0) {
            Open near = open_node(node.first);
            Open far = open_node(node.first + 1);
            if (far.least < near.least) {
                std::swap(near, far);
            }
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        const FourFloats squared_least = least.squared(fours_[node.first / 4]);
        for (std::uint32_t i = 0; i < node.count; ++i) {
            if (squared_least[i] > most) {
                continue;
            }
            const std::uint32_t slot = node.first + i;
            const Corners triangle = corners_at(slot);
            const Vec3 on_triangle = closest_on_triangle(point, triangle);
            const double squared = (on_triangle - point).squaredNorm();
            if (squared < best || (squared == best && (!found || numbers_[slot] < hit.triangle))) {
                best = squared;
                most = limit();
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
