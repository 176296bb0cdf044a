#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/turned_box.hpp"
#include "engine/math/four_floats.hpp"
#include "engine/math/math.hpp"

// Triangles found by ray, by nearness and by sphere. The tree only leaves out what cannot answer:
// every answer comes from a closed form in double precision on the triangle itself.
// Sources: Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007 (the build);
// Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, 2013 (rays slip through no shared
// edge); closest_point.hpp.
namespace handhold {

struct TriangleHit {
    std::uint32_t triangle = 0;  // as numbered at construction
    Vec3 point = Vec3::Zero();   // on the triangle
    double distance_m = 0.0;     // from the ray's start, or from the query point
};

// Four triangles side by side, in floats: for what only has to tell far from near.
struct FourTriangles {
    FourCorners corner = {};
    std::array<FourFloats, 3> normal = {};  // by coordinate: unit, or zero where there is none
};

// Refers to nothing outside of itself, copies what it needs. No query allocates; all may run on any
// number of threads at once. A query that is not finite meets nothing.
class TriangleBvh {
  public:
    TriangleBvh() = default;  // of no triangle
    // Precondition: indices in range. Triangles with a corner that is not finite are never found.
    // The same input makes the same tree on every compiler.
    TriangleBvh(std::span<const Vec3> positions,
                std::span<const std::array<std::uint32_t, 3>> triangles);

    // The first triangle that the segment meets, whichever of its sides is turned to it. No segment
    // slips between two triangles with a common edge. What is seen exactly from the edge is missed:
    // its neighbours are met. Of several at one distance the lowest number.
    std::optional<TriangleHit> cast_ray(const Vec3& from, const Vec3& to) const;
    // The nearest triangle, of those as near as max_distance_m (infinity: of all). Of several
    // at one distance the lowest number.
    std::optional<TriangleHit> closest_point(const Vec3& point, double max_distance_m) const;
    // visit(triangle) for each triangle with a point as near as radius_m: in the tree's order,
    // neighbours together, ascending within a leaf; always the same order.
    template <typename Visit>
    void visit_in_sphere(const Vec3& center, double radius_m, Visit&& visit) const;

    // Of triangles as near as radius_m, and a few that are hardly farther, those that look towards
    // `side`: the sum of their normals, each as long as twice its triangle's area, but no longer
    // than most_m2. In floats: off by roundings of the mesh's reach.
    Vec3 areas_in_sphere(const Vec3& center, double radius_m, const Vec3& side,
                         double most_m2) const;

    // visit(first_slot, count, four) for each leaf that may meet the box, which is about origin(),
    // as the corners of `four` are: its one to four triangles, the last repeated. More triangles
    // than would be needed, but the cheapest way to them; always in the tree's order.
    template <typename Visit>
    void visit_near_box(const TurnedBox& box, Visit&& visit) const;
    const Vec3& origin() const { return origin_; }
    // No coordinate of a corner about the origin is beyond.
    double reach_m() const;

    // A triangle of a visited leaf: its number at construction, and its corners in doubles.
    // Precondition: slot < 4 * leaves.
    std::uint32_t number_at(std::uint32_t slot) const { return numbers_[slot]; }
    std::array<Vec3, 3> corners_at(std::uint32_t slot) const {
        const auto& [a, b, c] = slots_[slot];
        return {positions_[a], positions_[b], positions_[c]};
    }
    // False where surely no triangle is as near as radius_m.
    bool may_be_near(const Vec3& point, double radius_m) const {
        return !nodes_.empty() &&
               squared_distance(nodes_.front(), point - origin_) <= radius_m * radius_m;
    }

    std::size_t triangle_count() const { return triangle_count_; }  // that can be found
    std::size_t memory_bytes() const;

  private:
    friend class BvhBuilder;

    // Children of an inner node lie side by side. Boxes are about origin_, with k_padding of the
    // mesh's reach to spare, so that rounding hides nothing.
    struct Node {
        std::array<float, 3> low = {};
        std::uint32_t first = 0;  // inner: its first child; leaf: its first slot
        std::array<float, 3> high = {};
        std::uint32_t count = 0;  // of the leaf's slots; 0: inner
    };
    static constexpr std::size_t k_most_depth = 64;

    static double squared_distance(const Node& node, const Vec3& point_about_origin) {
        double sum = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double below = static_cast<double>(node.low[i]) - point_about_origin[axis];
            const double above = point_about_origin[axis] - static_cast<double>(node.high[i]);
            const double out = below > above ? below : above;
            sum += out > 0.0 ? out * out : 0.0;
        }
        return sum;
    }
    // Of the box's farthest corner.
    static double farthest_squared(const Node& node, const Vec3& point_about_origin) {
        double sum = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double below = point_about_origin[axis] - static_cast<double>(node.low[i]);
            const double above = static_cast<double>(node.high[i]) - point_about_origin[axis];
            const double out = below > above ? below : above;
            sum += out * out;
        }
        return sum;
    }
    bool meets_sphere(std::uint32_t slot, const Vec3& center, double squared_radius) const;

    Vec3 origin_ = Vec3::Zero();
    std::vector<Node> nodes_;  // the root first
    std::vector<Vec3> positions_;
    // In leaf order. Each leaf has four slots; those beyond its count repeat its last one.
    std::vector<std::array<std::uint32_t, 3>> slots_;  // corners of the triangles
    std::vector<std::uint32_t> numbers_;               // of the triangles
    std::vector<FourTriangles> fours_;                 // of each leaf
    std::size_t triangle_count_ = 0;
};

template <typename Visit>
void TriangleBvh::visit_near_box(const TurnedBox& box, Visit&& visit) const {
    if (nodes_.empty()) {
        return;
    }
    const TurnedBoxTest test(box, reach_m());
    std::array<std::uint32_t, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    if (test.may_meet(nodes_[0].low, nodes_[0].high)) {
        stack[depth++] = 0;
    }
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (node.count == 0) {
            const std::uint32_t left = node.first;
            const std::uint32_t right = left + 1;
            if (test.may_meet(nodes_[right].low, nodes_[right].high)) {
                stack[depth++] = right;
            }
            if (test.may_meet(nodes_[left].low, nodes_[left].high)) {
                stack[depth++] = left;
            }
            continue;
        }
        visit(node.first, node.count, fours_[node.first / 4]);
    }
}

template <typename Visit>
void TriangleBvh::visit_in_sphere(const Vec3& center, double radius_m, Visit&& visit) const {
    const double squared_radius = radius_m * radius_m;
    if (nodes_.empty() || !is_finite(center) || !(radius_m >= 0.0)) {
        return;
    }
    const Vec3 local = center - origin_;
    std::array<std::uint32_t, k_most_depth + 1> stack;  // NOLINT(*-member-init): filled as it grows
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (!(squared_distance(node, local) <= squared_radius)) {
            continue;
        }
        if (node.count == 0) {
            stack[depth++] = node.first + 1;
            stack[depth++] = node.first;
            continue;
        }
        const bool is_within = farthest_squared(node, local) <= squared_radius;
        for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
            if (is_within || meets_sphere(slot, center, squared_radius)) {
                visit(numbers_[slot]);
            }
        }
    }
}

}  // namespace handhold
