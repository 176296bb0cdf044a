#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/distance_lower_bound.hpp"
#include "engine/geometry/oriented_box.hpp"
#include "engine/geometry/shapes4.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

// Triangles found by ray, by nearness and by sphere. The tree only leaves out what cannot answer:
// every answer comes from a closed form in double precision on the triangle itself.
// Sources: Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007 (the build);
// Dammertz, Hanika, Keller, Shallow Bounding Volume Hierarchies, 2008 (four children to a node);
// Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, 2013 (rays slip through no shared
// edge); closest_point.hpp.
namespace handhold {

struct TriangleHit {
    std::uint32_t triangle = 0;  // as numbered at construction
    Vec3 point = Vec3::Zero();   // on the triangle
    double distance_m = 0.0;     // from the ray's start, or from the query point
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
    // than max_area_m2. In floats: off by roundings of the mesh's reach.
    Vec3 areas_in_sphere(const Vec3& center, double radius_m, const Vec3& side,
                         double max_area_m2) const;

    // visit(first_slot, count, four) for each leaf that may meet the box, which is about origin(),
    // as the corners of `four` are: its one to four triangles, the last repeated. More triangles
    // than would be needed, but the cheapest way to them; always in the tree's order.
    template <typename Visit>
    void visit_near_box(const OrientedBox& box, Visit&& visit) const;
    const Vec3& origin() const { return origin_; }
    // No coordinate of a corner about the origin is beyond.
    double reach_m() const { return std::max(high_.maxCoeff(), -low_.minCoeff()); }

    // A triangle of a visited leaf: its number at construction, and its corners in doubles.
    // Precondition: slot < 4 * leaves.
    std::uint32_t number_at(std::uint32_t slot) const { return numbers_[slot]; }
    std::array<Vec3, 3> corners_at(std::uint32_t slot) const {
        const auto& [a, b, c] = slots_[slot];
        return {positions_[a], positions_[b], positions_[c]};
    }
    // False where surely no triangle is as near as radius_m.
    bool may_be_near(const Vec3& point, double radius_m) const {
        const Vec3 local = point - origin_;
        const Vec3 out = (low_ - local).cwiseMax(local - high_).cwiseMax(0.0);
        return triangle_count_ > 0 && out.squaredNorm() <= radius_m * radius_m;
    }

    std::size_t triangle_count() const { return triangle_count_; }  // that can be found
    std::size_t memory_bytes() const;

  private:
    friend class BvhBuilder;

    // A node of the tree, or a leaf.
    struct Child {
        std::uint32_t place;  // of the node; of the leaf's first slot
        std::uint32_t count;  // of the leaf's slots; 0: a node

        bool is_there() const { return place != k_no_child.place; }
        bool is_leaf() const { return count > 0; }
    };
    static constexpr Child k_no_child = {0xffffffff, 0};
    // Up to four children side by side. Boxes are about origin_, with k_padding of the mesh's reach
    // to spare, so that rounding hides nothing. That of a child that is not there is empty.
    struct Node {
        Boxes4 box;
        std::array<Child, 4> child = {k_no_child, k_no_child, k_no_child, k_no_child};
    };
    static constexpr std::size_t k_max_depth = 64;
    static constexpr std::size_t k_max_open = 3 * k_max_depth + 1;  // of each node three wait

    // visit(first_slot, count) for the leaves of nodes that may be met: may_meet(boxes) tells
    // which. In the tree's order.
    template <typename MayMeet, typename Visit>
    void visit_leaves(const MayMeet& may_meet, Visit&& visit) const;
    bool meets_sphere(std::uint32_t slot, const Vec3& center, double squared_radius) const;

    Vec3 origin_ = Vec3::Zero();
    Vec3 low_ = Vec3::Zero();  // of the box of all, about origin_
    Vec3 high_ = Vec3::Zero();
    std::vector<Node> nodes_;  // the root first
    std::vector<Vec3> positions_;
    // In leaf order. Each leaf has four slots; those beyond its count repeat its last one.
    std::vector<std::array<std::uint32_t, 3>> slots_;  // corners of the triangles
    std::vector<std::uint32_t> numbers_;               // of the triangles
    std::vector<Triangles4> fours_;                    // of each leaf
    std::size_t triangle_count_ = 0;
};

template <typename MayMeet, typename Visit>
void TriangleBvh::visit_leaves(const MayMeet& may_meet, Visit&& visit) const {
    if (nodes_.empty()) {
        return;
    }
    std::array<Child, k_max_open> open;  // NOLINT(*-member-init): filled as it grows
    std::size_t count = 0;
    open[count++] = {0, 0};
    while (count > 0) {
        const Child next = open[--count];
        if (next.is_leaf()) {
            visit(next.place, next.count);
            continue;
        }
        const Node& node = nodes_[next.place];
        const Int4 is_met = may_meet(node.box);
        for (std::size_t i = 4; i-- > 0;) {
            if (is_met[i] != 0 && node.child[i].is_there()) {
                open[count++] = node.child[i];
            }
        }
    }
}

template <typename Visit>
void TriangleBvh::visit_near_box(const OrientedBox& box, Visit&& visit) const {
    const OrientedBoxTest test(box, reach_m());
    visit_leaves([&](const Boxes4& boxes) { return test.may_meet(boxes); },
                 [&](std::uint32_t first_slot, std::uint32_t count) {
                     visit(first_slot, count, fours_[first_slot / 4]);
                 });
}

template <typename Visit>
void TriangleBvh::visit_in_sphere(const Vec3& center, double radius_m, Visit&& visit) const {
    if (!is_finite(center) || !(radius_m >= 0.0)) {
        return;
    }
    const DistanceLowerBound least(center - origin_, reach_m());
    const double squared_radius = radius_m * radius_m;
    const Float4 most = splat4(DistanceLowerBound::limit(squared_radius));
    visit_leaves([&](const Boxes4& boxes) -> Int4 { return least.squared(boxes) <= most; },
                 [&](std::uint32_t first_slot, std::uint32_t count) {
                     for (std::uint32_t slot = first_slot; slot < first_slot + count; ++slot) {
                         if (meets_sphere(slot, center, squared_radius)) {
                             visit(numbers_[slot]);
                         }
                     }
                 });
}

}  // namespace handhold
