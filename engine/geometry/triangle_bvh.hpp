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

// Ray, nearest-point and sphere queries on triangles. The tree only rejects triangles; every result
// comes from a closed form in doubles. Sources: Wald, On fast Construction of SAH-based Bounding
// Volume Hierarchies, 2007 (build); Dammertz, Hanika, Keller, Shallow Bounding Volume Hierarchies,
// 2008 (four children per node); Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, 2013
// (no gaps at shared edges); closest_point.hpp.
namespace handhold {

struct TriangleHit {
    std::uint32_t triangle = 0;  // index in the list from which the tree was built
    Vec3 point = Vec3::Zero();   // point on the triangle
    double distance_m = 0.0;     // distance from the ray's start or the query point
};

// Copies all data that it needs. Queries do not allocate and may run on any number of threads at
// once. A non-finite query hits nothing.
class TriangleBvh {
  public:
    TriangleBvh() = default;  // empty
    // Precondition: indices in range. Triangles with a non-finite corner are never found. The same
    // input gives the same tree on every compiler.
    TriangleBvh(std::span<const Vec3> positions,
                std::span<const std::array<std::uint32_t, 3>> triangles);
    // Several times as fast, for callers that know more of their triangles.
    struct Known {
        // A permutation of the triangles in which neighbours are close: halved, instead of
        // searching for the best splits.
        std::span<const std::uint32_t> order;
        std::span<const Vec3> normals;  // unit normals of the triangles; zero: degenerate
    };
    TriangleBvh(std::span<const Vec3> positions,
                std::span<const std::array<std::uint32_t, 3>> triangles, const Known& known);

    // First triangle that the segment hits, from either side. No segment passes between two
    // triangles that share an edge. A triangle seen exactly edge-on is missed, but its neighbours
    // are hit. If several are equally near, returns the lowest index.
    std::optional<TriangleHit> cast_ray(const Vec3& from, const Vec3& to) const;
    // Nearest triangle within max_distance_m (may be infinity). If several are equally near,
    // returns the lowest index.
    std::optional<TriangleHit> closest_point(const Vec3& point, double max_distance_m) const;
    // Calls visit(triangle) for each triangle within radius_m, always in the same order.
    template <typename Visit>
    void visit_in_sphere(const Vec3& center, double radius_m, Visit&& visit) const;

    // Sums the unit normals of the triangles within radius_m that face `side`, a unit vector. The
    // weight of a normal is twice the triangle's area, but at most max_area_m2, times the cosine of
    // the angle between normal and `side`. A few triangles that are slightly farther away may be
    // included. Computed in floats: errors scale with the mesh's size.
    Vec3 areas_in_sphere(const Vec3& center, double radius_m, const Vec3& side,
                         double max_area_m2) const;

    // Calls visit(first_slot, count, four) for each leaf that may overlap the box, in tree order.
    // The box and the corners of `four` are relative to origin(). A leaf has one to four triangles;
    // the last one is repeated. Some of the triangles do not overlap the box: this is the cheapest
    // query, and the caller tests them.
    template <typename Visit>
    void visit_near_box(const OrientedBox& box, Visit&& visit) const;
    const Vec3& origin() const { return origin_; }
    // Upper bound on the absolute values of all corner coordinates relative to origin().
    double reach_m() const { return std::max(high_.maxCoeff(), -low_.minCoeff()); }

    // Returns the triangles in the order of the leaves: Known::order of an equal tree of moved
    // corners.
    std::vector<std::uint32_t> leaf_order() const;

    // A triangle of a visited leaf: its index in the list from which the tree was built, and its
    // corners. Precondition: slot < 4 * number of leaves.
    std::uint32_t number_at(std::uint32_t slot) const { return numbers_[slot]; }
    std::array<Vec3, 3> corners_at(std::uint32_t slot) const {
        const auto& [a, b, c] = slots_[slot];
        return {positions_[a], positions_[b], positions_[c]};
    }
    // No triangle is farther from the origin of the positions than this.
    double farthest_m() const {
        return (origin_ + low_).cwiseAbs().cwiseMax((origin_ + high_).cwiseAbs()).norm();
    }
    // False only if no triangle is within radius_m.
    bool may_be_near(const Vec3& point, double radius_m) const {
        const Vec3 local = point - origin_;
        const Vec3 out = (low_ - local).cwiseMax(local - high_).cwiseMax(0.0);
        return triangle_count_ > 0 && out.squaredNorm() <= radius_m * radius_m;
    }

    // Number of triangles in the tree. Triangles with a non-finite corner are not in it.
    std::size_t triangle_count() const { return triangle_count_; }
    std::size_t memory_bytes() const;

  private:
    friend class BvhBuilder;

    // An inner node or a leaf.
    struct Child {
        std::uint32_t place;  // inner: node index; leaf: first slot
        std::uint32_t count;  // leaf: number of slots; 0: inner

        bool is_there() const { return place != k_no_child.place; }
        bool is_leaf() const { return count > 0; }
    };
    static constexpr Child k_no_child = {0xffffffff, 0};
    // Up to four children. Boxes are relative to origin_ and padded against rounding. Missing
    // children have empty boxes.
    struct Node {
        Boxes4 box;
        std::array<Child, 4> child = {k_no_child, k_no_child, k_no_child, k_no_child};
    };
    static constexpr std::size_t k_max_depth = 64;
    // Largest number of pending items: at most three pending children per level.
    static constexpr std::size_t k_max_open = 3 * k_max_depth + 1;

    // Calls visit(first_slot, count) for the leaves of all nodes whose boxes pass may_meet(boxes),
    // in tree order.
    template <typename MayMeet, typename Visit>
    void visit_leaves(const MayMeet& may_meet, Visit&& visit) const;
    bool meets_sphere(std::uint32_t slot, const Vec3& center, double squared_radius) const;

    Vec3 origin_ = Vec3::Zero();
    Vec3 low_ = Vec3::Zero();  // lower corner of the whole tree's box, relative to origin_
    Vec3 high_ = Vec3::Zero();
    std::vector<Node> nodes_;  // root first
    std::vector<Vec3> positions_;
    // In leaf order. Each leaf has four slots; unused slots repeat its last triangle.
    std::vector<std::array<std::uint32_t, 3>> slots_;  // corner indices
    // Triangle indices in the list from which the tree was built.
    std::vector<std::uint32_t> numbers_;
    std::vector<Triangles4> fours_;  // one per leaf
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
    const DistanceLowerBound lower_bound(center - origin_, reach_m());
    const double squared_radius = radius_m * radius_m;
    const Float4 max_squared = splat4(DistanceLowerBound::limit(squared_radius));
    visit_leaves(
        [&](const Boxes4& boxes) -> Int4 { return lower_bound.squared(boxes) <= max_squared; },
        [&](std::uint32_t first_slot, std::uint32_t count) {
            for (std::uint32_t slot = first_slot; slot < first_slot + count; ++slot) {
                if (meets_sphere(slot, center, squared_radius)) {
                    visit(numbers_[slot]);
                }
            }
        });
}

}  // namespace handhold
