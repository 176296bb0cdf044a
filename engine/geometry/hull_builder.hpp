#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/convex_hull.hpp"

namespace handhold {

// Quickhull over triangles, which are merged into faces at the end. An initial tetrahedron grows by
// the farthest outside point until no point is outside or the hull has k_max_hull_corners corners.
class HullBuilder {
  public:
    // `points`: sorted and unique.
    explicit HullBuilder(std::vector<Vec3> points) : points_(std::move(points)) {}
    // nullopt if the points have no volume.
    std::optional<ConvexHull> build();

  private:
    using Index = std::uint32_t;
    static constexpr Index k_none = std::numeric_limits<Index>::max();

    struct Plane {
        Vec3 normal = Vec3::UnitY();
        double offset_m = 0.0;

        double height(const Vec3& point) const { return normal.dot(point) - offset_m; }
    };

    struct Triangle {
        std::array<Index, 3> corner{};
        std::array<Index, 3> neighbour{};  // [i]: across the edge from corner i to corner i + 1
        Plane plane;
        std::vector<Index> outside;  // points that see this triangle; each point is listed once
        Index farthest = k_none;     // farthest point of `outside`
        double farthest_m = 0.0;
        bool gone = false;
    };

    struct Edge {
        Index from = 0;
        Index to = 0;
        Index beyond = 0;  // triangle on the other side
    };

    static Plane plane_through(const Vec3& a, const Vec3& b, const Vec3& c);
    // Builds a large initial tetrahedron. False if all points are coplanar.
    bool start();
    // Triangle with the farthest outside point; k_none if there is none.
    Index outermost() const;
    // Adds the face's farthest point. False if the horizon is not one loop; the point is then
    // dropped.
    bool add_point(Index face);
    void forget_farthest(Triangle& triangle) const;
    void find_visible(Index face, const Vec3& point);
    bool order_horizon();
    void add_cone(Index point);
    Index add_triangle(Index a, Index b, Index c);
    void assign(std::span<const Index> candidates, Index first_triangle);
    ConvexHull collect() const;
    std::vector<HullFace> flat_faces() const;
    static void drop_edge_points(std::vector<HullFace>& faces);
    std::vector<Index> flat_group(Index seed, std::vector<bool>& taken) const;
    std::vector<Index> outline(const std::vector<Index>& group) const;

    template <typename Score>
    std::pair<Index, double> farthest_by(const Score& score) const {
        Index at = 0;
        double max_score = -1.0;
        for (Index i = 0; i < points_.size(); ++i) {
            if (const double value = score(points_[i]); value > max_score) {
                max_score = value;
                at = i;
            }
        }
        return {at, max_score};
    }

    std::vector<Vec3> points_;
    std::vector<Triangle> triangles_;
    std::vector<Index> visible_;
    std::vector<Edge> horizon_;
    double flat_m_ = 0.0;
};

}  // namespace handhold
