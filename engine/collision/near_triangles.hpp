#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "engine/collision/bounds.hpp"
#include "engine/geometry/closest_point.hpp"

namespace handhold {

// A triangle near a body, in near space: b's axes with the origin at a's position.
struct NearTriangle {
    Corners corners_ns;
    Vec3 normal = Vec3::UnitY();  // unit; either side, because level meshes have mixed winding
    Bounds box_ns;
};

// The triangles of a mesh near one convex shape, in a hierarchy of boxes. Each box covers eight
// consecutive entries of the level below, so that a point query tests few boxes. Add neighbouring
// triangles one after another, in TriangleTree's order; any other order is slower.
class NearTriangles {
  public:
    void clear();
    // Skips degenerate triangles: they have no normal, and their neighbours cover their edges.
    void add(const Corners& corners_ns);
    // Call after the last add and before any_at.
    void build();

    std::span<const NearTriangle> all() const { return triangles_; }
    bool empty() const { return triangles_.empty(); }
    // True if test(triangle) is true for any triangle whose box is within reach_m of the point.
    template <typename Test>
    bool any_at(const Vec3& point, double reach_m, const Test& test) const {
        const Bounds here = bounds_of(point, point).grown(reach_m);
        return any_in(levels_.size(), 0, levels_.empty() ? triangles_.size() : top_count(), here,
                      test);
    }

  private:
    static constexpr std::size_t k_run = 8;

    std::size_t top_count() const { return boxes_.size() - levels_.back(); }
    // Tests the entries [first, last) of a level. Level 0 holds the triangles. Level l > 0 holds
    // the boxes that start at index levels_[l-1].
    template <typename Test>
    bool any_in(std::size_t level, std::size_t first, std::size_t last, const Bounds& here,
                const Test& test) const {
        for (std::size_t i = first; i < last; ++i) {
            if (level == 0) {
                if (overlaps(triangles_[i].box_ns, here) && test(triangles_[i])) {
                    return true;
                }
            } else if (overlaps(boxes_[levels_[level - 1] + i], here)) {
                const std::size_t end = std::min(k_run * (i + 1), count_of(level - 1));
                if (any_in(level - 1, k_run * i, end, here, test)) {
                    return true;
                }
            }
        }
        return false;
    }
    std::size_t count_of(std::size_t level) const {
        return level == 0 ? triangles_.size() : levels_[level] - levels_[level - 1];
    }

    std::vector<NearTriangle> triangles_;
    std::vector<Bounds> boxes_;
    std::vector<std::size_t> levels_;  // index of each level's first box
};

}  // namespace handhold
