#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "engine/collision/bounds.hpp"
#include "engine/collision/closest_point.hpp"

namespace handhold {

// A triangle near a body, in near space: b's axes about a's place.
struct NearTriangle {
    Corners corners_ns;
    Vec3 normal = Vec3::UnitY();  // unit; either side: winding is mixed in real levels
    Bounds box_ns;
};

// The triangles of a mesh that are near one convex shape, with boxes about runs of eight of them,
// about eight such boxes, and so on: what is asked at a point looks at few. Neighbours must come
// one after another, as a mesh's tree gives them; otherwise only time is lost.
class NearTriangles {
  public:
    void clear();
    // One without area is left out: it has no normal, and its edges are its neighbours'.
    void add(const Corners& corners_ns);
    // After the last add, before any_at.
    void build();

    std::span<const NearTriangle> all() const { return triangles_; }
    bool empty() const { return triangles_.empty(); }
    // True where test(triangle) is for one of the triangles whose box comes within reach_m of the
    // point.
    template <typename Test>
    bool any_at(const Vec3& point, double reach_m, const Test& test) const {
        const Bounds here = bounds_of(point, point).grown(reach_m);
        return any_in(levels_.size(), 0, levels_.empty() ? triangles_.size() : top_count(), here,
                      test);
    }

  private:
    static constexpr std::size_t k_run = 8;

    std::size_t top_count() const { return boxes_.size() - levels_.back(); }
    // Of entries [first, last) of a level: 0 are the triangles, level l the boxes from levels_[l-1]
    // on.
    template <typename Test>
    bool any_in(std::size_t level, std::size_t first, std::size_t last, const Bounds& here,
                const Test& test) const {
        for (std::size_t i = first; i < last; ++i) {
            if (level == 0) {
                if (meet(triangles_[i].box_ns, here) && test(triangles_[i])) {
                    return true;
                }
            } else if (meet(boxes_[levels_[level - 1] + i], here)) {
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
    std::vector<std::size_t> levels_;  // first of each level's boxes
};

}  // namespace handhold
