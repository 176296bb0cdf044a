#include "engine/geometry/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/geometry/bvh_builder.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/distance_lower_bound.hpp"
#include "engine/math/double4.hpp"

namespace handhold {
namespace {

// A segment and its shear, as Woop's test needs them: the shear maps the segment to one that runs
// along axis[2] from the origin.
struct ShearedRay {
    Vec3 from;
    std::array<int, 3> axis;  // axis[2]: the axis along which the displacement is largest
    // Let d be the displacement along axis[2]. [0], [1]: displacement along axis[0] and axis[1],
    // divided by d. [2]: 1 / d.
    std::array<double, 3> shear;
};

ShearedRay shear(const Vec3& from, const Vec3& displacement) {
    ShearedRay ray;
    ray.from = from;
    int along = 0;
    displacement.cwiseAbs().maxCoeff(&along);
    ray.axis = {(along + 1) % 3, (along + 2) % 3, along};
    ray.shear = {displacement[ray.axis[0]] / displacement[along],
                 displacement[ray.axis[1]] / displacement[along], 1.0 / displacement[along]};
    return ray;
}

// Fraction of the segment at which it hits the triangle; negative if it misses. Two triangles that
// share an edge compute the same edge function with opposite signs, so the segment hits one of
// them.
double meet_fraction(const ShearedRay& ray, const Corners& corners) {
    std::array<std::array<double, 3>, 3> p;  // corners in the ray's frame
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
    // Divides before adding: a sliver's sum may be so small that its inverse is infinite.
    const double fraction = (u / sum) * p[0][2] + (v / sum) * p[1][2] + (w / sum) * p[2][2];
    return fraction >= 0.0 && fraction <= 1.0 ? fraction : -1.0;
}

double bounded_inverse(double x) {
    constexpr double k_huge = 1e290;  // finite, because infinity times zero is NaN
    const double inverse = 1.0 / x;
    return std::abs(inverse) <= k_huge ? inverse : std::copysign(k_huge, inverse);
}

// Slab test of a segment against boxes.
class RayEntry {
  public:
    // `start` is relative to the tree's origin.
    RayEntry(const Vec3& start, const Vec3& displacement) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            start_[i] = same_four(start[axis]);
            inverse_[i] = same_four(bounded_inverse(displacement[axis]));
        }
    }

    // Fraction of the segment at which it enters each box; infinity if it does not enter before
    // `max_fraction`.
    Double4 of(const Boxes4& boxes, double max_fraction) const {
        Double4 enter = zero4();
        Double4 leave = same_four(max_fraction);
        for (std::size_t i = 0; i < 3; ++i) {
            const Double4 a =
                (__builtin_convertvector(boxes.low[i], Double4) - start_[i]) * inverse_[i];
            const Double4 b =
                (__builtin_convertvector(boxes.high[i], Double4) - start_[i]) * inverse_[i];
            const Double4 first = b < a ? b : a;
            const Double4 last = b < a ? a : b;
            enter = enter < first ? first : enter;
            leave = last < leave ? last : leave;
        }
        return enter <= leave ? enter : same_four(std::numeric_limits<double>::infinity());
    }

  private:
    static Double4 same_four(double value) { return Double4{value, value, value, value}; }

    Double4 start_[3];    // C arrays of vector types, as in double4.hpp
    Double4 inverse_[3];  // NOLINT(*-avoid-c-arrays)
};

// Stack of pending nodes and leaves. Of the children of one node, the nearest is on top.
template <typename Item, typename Distance, std::size_t KMax>
class NearestFirstStack {
  public:
    struct Open {
        Item item;
        Distance distance;
    };

    bool is_empty() const { return count_ == 0; }
    Open take() { return open_[--count_]; }

    // Items put after this call belong to one node and are sorted among each other.
    void begin_node() { first_ = count_; }
    void put(const Item& item, Distance distance) {
        std::size_t place = count_++;
        for (; place > first_ && open_[place - 1].distance < distance; --place) {
            open_[place] = open_[place - 1];
        }
        open_[place] = {item, distance};
    }

  private:
    std::array<Open, KMax> open_;  // NOLINT(*-member-init): filled as it grows
    std::size_t count_ = 0;
    std::size_t first_ = 0;  // first item of the current node
};

// Index of the minimum of the first `count` values.
std::uint32_t index_of_min(const Float4& values, std::uint32_t count) {
    std::uint32_t min_index = 0;
    for (std::uint32_t i = 1; i < count; ++i) {
        min_index = values[i] < values[min_index] ? i : min_index;
    }
    return min_index;
}

// Sums the area vectors of triangles that face a side, weighted by the cosine of the angle to it.
class FacingAreas {
  public:
    FacingAreas(const Vec3& side, double max_area_m2)
        : side_{splat4(side.x()), splat4(side.y()), splat4(side.z())},
          max_area_(splat4(max_area_m2)) {}

    // Uses the triangles in `is_wanted` among the first `count`.
    Vec3 areas_of(const Triangles4& four, const Int4& is_wanted, std::uint32_t count) const {
        const Float4 zero = {};
        std::array<Float4, 3> b;
        std::array<Float4, 3> c;
        for (std::size_t i = 0; i < 3; ++i) {
            b[i] = four.corner[1][i] - four.corner[0][i];
            c[i] = four.corner[2][i] - four.corner[0][i];
        }
        const Float4 size = (b[1] * c[2] - b[2] * c[1]) * four.normal[0] +
                            (b[2] * c[0] - b[0] * c[2]) * four.normal[1] +
                            (b[0] * c[1] - b[1] * c[0]) * four.normal[2];
        const Float4 facing =
            side_[0] * four.normal[0] + side_[1] * four.normal[1] + side_[2] * four.normal[2];
        const Int4 counts = is_wanted & (facing > zero);
        const Float4 area = counts ? facing * lower(higher(size, zero), max_area_) : zero;
        Vec3 sum = Vec3::Zero();
        for (std::uint32_t i = 0; i < count; ++i) {
            sum += static_cast<double>(area[i]) * Vec3(static_cast<double>(four.normal[0][i]),
                                                       static_cast<double>(four.normal[1][i]),
                                                       static_cast<double>(four.normal[2][i]));
        }
        return sum;
    }

  private:
    std::array<Float4, 3> side_;
    Float4 max_area_;
};

// Squared distance to the triangle's bounding box: a lower bound up to rounding.
double box_squared(const Vec3& point, const Corners& corners) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

TriangleBvh::TriangleBvh(std::span<const Vec3> positions,
                         std::span<const std::array<std::uint32_t, 3>> triangles) {
    BvhBuilder(*this, positions, triangles).build();
}

TriangleBvh::TriangleBvh(std::span<const Vec3> positions,
                         std::span<const std::array<std::uint32_t, 3>> triangles,
                         const Known& known) {
    HH_CHECK(known.order.size() == triangles.size(), "an order names each triangle once",
             known.order.size());
    HH_CHECK(known.normals.size() == triangles.size(), "each triangle has a normal",
             known.normals.size());
    BvhBuilder(*this, positions, triangles, known).build();
}

std::vector<std::uint32_t> TriangleBvh::leaf_order() const {
    std::vector<std::uint32_t> order;
    order.reserve(triangle_count_);
    for (std::size_t slot = 0; slot < numbers_.size(); ++slot) {
        if (slot % 4 == 0 || numbers_[slot] != numbers_[slot - 1]) {
            order.push_back(numbers_[slot]);
        }
    }
    return order;
}

std::size_t TriangleBvh::memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + positions_.capacity() * sizeof(Vec3) +
           slots_.capacity() * sizeof(slots_[0]) + numbers_.capacity() * sizeof(numbers_[0]) +
           fours_.capacity() * sizeof(fours_[0]);
}

Vec3 TriangleBvh::areas_in_sphere(const Vec3& center, double radius_m, const Vec3& side,
                                  double max_area_m2) const {
    Vec3 sum = Vec3::Zero();
    if (!is_finite(center) || !(radius_m >= 0.0)) {
        return sum;
    }
    const DistanceLowerBound lower_bound(center - origin_, reach_m());
    const Float4 max_squared = splat4(radius_m * radius_m);
    const FacingAreas facing_areas(side, max_area_m2);
    visit_leaves(
        [&](const Boxes4& boxes) -> Int4 { return lower_bound.squared(boxes) <= max_squared; },
        [&](std::uint32_t first_slot, std::uint32_t count) {
            const Triangles4& four = fours_[first_slot / 4];
            sum += facing_areas.areas_of(four, lower_bound.squared(four) <= max_squared, count);
        });
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
    return box_squared(center, triangle) <= squared_radius * DistanceLowerBound::k_slack &&
           (closest_on_triangle(center, triangle) - center).squaredNorm() <= squared_radius;
}

std::optional<TriangleHit> TriangleBvh::cast_ray(const Vec3& from, const Vec3& to) const {
    const Vec3 displacement = to - from;
    if (nodes_.empty() || !is_finite(from) || !is_finite(displacement) ||
        displacement.isZero(0.0)) {
        return std::nullopt;
    }
    const ShearedRay ray = shear(from, displacement);
    const RayEntry entry(from - origin_, displacement);
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t best_number = 0;
    NearestFirstStack<Child, double, k_max_open> open;
    open.put({0, 0}, 0.0);
    while (!open.is_empty()) {
        const auto [next, enters] = open.take();
        if (!(enters <= std::min(1.0, best))) {
            continue;
        }
        if (!next.is_leaf()) {
            const Node& node = nodes_[next.place];
            const double max_fraction = std::min(1.0, best);
            const Double4 fraction = entry.of(node.box, max_fraction);
            open.begin_node();
            for (std::size_t i = 0; i < 4; ++i) {
                if (fraction[i] <= max_fraction && node.child[i].is_there()) {
                    open.put(node.child[i], fraction[i]);
                }
            }
            continue;
        }
        for (std::uint32_t slot = next.place; slot < next.place + next.count; ++slot) {
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
    return TriangleHit{best_number, from + best * displacement, best * displacement.norm()};
}

std::optional<TriangleHit> TriangleBvh::closest_point(const Vec3& point,
                                                      double max_distance_m) const {
    if (nodes_.empty() || !is_finite(point) || !(max_distance_m >= 0.0)) {
        return std::nullopt;
    }
    const DistanceLowerBound lower_bound(point - origin_, reach_m());
    double best = max_distance_m * max_distance_m;
    TriangleHit hit;
    bool found = false;
    float max_squared = DistanceLowerBound::limit(best);
    NearestFirstStack<Child, float, k_max_open> open;
    open.put({0, 0}, 0.0F);
    while (!open.is_empty()) {
        const auto [next, bound_squared] = open.take();
        if (bound_squared > max_squared) {
            continue;
        }
        if (!next.is_leaf()) {
            const Node& node = nodes_[next.place];
            const Float4 squared = lower_bound.squared(node.box);
            open.begin_node();
            for (std::size_t i = 0; i < 4; ++i) {
                if (squared[i] <= max_squared && node.child[i].is_there()) {
                    open.put(node.child[i], squared[i]);
                }
            }
            continue;
        }
        const Triangles4& four = fours_[next.place / 4];
        if (!any_of(lower_bound.squared(four) <= splat4(max_squared))) {
            continue;
        }
        Float4 bounds_squared = lower_bound.squared_tight(four);
        for (std::uint32_t tested = 0; tested < next.count; ++tested) {
            const std::uint32_t i = index_of_min(bounds_squared, next.count);
            if (bounds_squared[i] > max_squared) {
                break;
            }
            bounds_squared[i] = std::numeric_limits<float>::infinity();
            const std::uint32_t slot = next.place + i;
            const Vec3 on_triangle = closest_on_triangle(point, corners_at(slot));
            const double squared = (on_triangle - point).squaredNorm();
            if (squared < best || (squared == best && (!found || numbers_[slot] < hit.triangle))) {
                best = squared;
                max_squared = DistanceLowerBound::limit(best);
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
