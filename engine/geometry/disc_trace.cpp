#include "engine/geometry/disc_trace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/disc_cut.hpp"
#include "engine/geometry/triangle_set.hpp"

namespace handhold {
namespace {

class CrossingSearcher {
  public:
    CrossingSearcher(const SurfaceGraph& graph, const Disc& disc, TraceScratch& scratch)
        : graph_(graph), disc_(disc), open_(scratch.open), seen_(scratch.seen) {
        open_.clear();
        open_.reserve(3 * k_max_pops + k_max_starts);
    }

    CrossingSearch run(std::span<const GraphPoint> starts) {
        CrossingSearch found;
        for (const GraphPoint& start : starts) {
            push(start.triangle, start.point, 0.0);
        }
        while (!open_.empty() && found.pops < k_max_pops) {
            std::pop_heap(open_.begin(), open_.end(), later);
            const TraceScratch::Node node = open_.back();
            open_.pop_back();
            ++found.pops;
            const std::optional<TriangleCut> cut = cut_triangle(graph_, disc_, node.triangle);
            if (cut && reaches_disc(disc_, *cut)) {
                found.triangle = node.triangle;
                found.point = closest_on_segment(node.point, cut->point[0], cut->point[1]);
                break;
            }
            expand(node);
        }
        return found;
    }

  private:
    static bool later(const TraceScratch::Node& a, const TraceScratch::Node& b) {
        return a.cost_m != b.cost_m ? a.cost_m > b.cost_m : a.order > b.order;
    }

    void push(std::uint32_t triangle, const Vec3& point, double path_m) {
        if (triangle == k_no_triangle || !seen_.insert(triangle)) {
            return;
        }
        const std::array<double, 3> heights = corner_heights(graph_, disc_, triangle);
        const auto [low, high] = std::minmax({heights[0], heights[1], heights[2]});
        const double to_go_m = low >= 0.0 ? low : (high < 0.0 ? -high : 0.0);
        const double cost_m = path_m + 2.0 * to_go_m;
        open_.push_back({cost_m, path_m, triangle, pushed_++, point});
        std::push_heap(open_.begin(), open_.end(), later);
    }

    void expand(const TraceScratch::Node& node) {
        const auto& corners = graph_.triangles[node.triangle];
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t next = graph_.neighbours[node.triangle][i];
            if (next != k_no_triangle && is_edge_in_reach(graph_, disc_, node.triangle, i)) {
                const Vec3 point = closest_on_segment(node.point, graph_.positions[corners[i]],
                                                      graph_.positions[corners[(i + 1) % 3]]);
                push(next, point, node.path_m + (point - node.point).norm());
            }
        }
    }

    const SurfaceGraph& graph_;
    const Disc& disc_;
    std::vector<TraceScratch::Node>& open_;
    TriangleSet<1024> seen_;
    static_assert(1024 >= 2 * (3 * k_max_pops + k_max_starts));
    std::uint32_t pushed_ = 0;
};

// Follows a cut from triangle `start` over its cut edge `side`. Appends a point for each further
// edge that the cut crosses. run() returns true if the cut is a closed loop.
class CutWalk {
  public:
    CutWalk(const SurfaceGraph& graph, const Disc& disc, TraceScratch& scratch)
        : graph_(graph), disc_(disc), scratch_(scratch) {}

    bool run(std::uint32_t start, const TriangleCut& start_cut, std::size_t side) {
        std::uint32_t from = start;
        std::uint32_t at = graph_.neighbours[start][start_cut.edge[side]];
        Vec2 point = to_disc(disc_, start_cut.point[side]);
        while (at != k_no_triangle && steps_ < k_max_steps) {
            if (at == start) {
                return true;
            }
            const std::optional<TriangleCut> cut = cut_triangle(graph_, disc_, at);
            if (!cut) {
                break;  // the other two corners lie on one side: the cut ends here
            }
            const std::size_t in = graph_.neighbours[at][cut->edge[0]] == from ? 0 : 1;
            const std::size_t out = 1 - in;
            const Vec2 next = to_disc(disc_, cut->point[out]);
            ++steps_;
            if (distance_to_origin(point, next) > disc_.radius_m) {
                break;
            }
            scratch_.line.push_back(next);
            scratch_.line_triangle.push_back(at);
            point = next;
            from = at;
            at = graph_.neighbours[at][cut->edge[out]];
        }
        return false;
    }

    std::uint32_t steps() const { return steps_; }

  private:
    const SurfaceGraph& graph_;
    const Disc& disc_;
    TraceScratch& scratch_;
    std::uint32_t steps_ = 0;
};

// True if all points between `first` and `last` lie within k_straight_m of the line between them.
bool is_straight(const std::vector<Vec2>& line, std::size_t first, std::size_t last) {
    const Vec2 along = line[last] - line[first];
    const double length2 = along.squaredNorm();
    for (std::size_t i = first + 1; i < last; ++i) {
        const Vec2 from = line[i] - line[first];
        const double t = length2 > 0.0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0.0;
        if ((from - t * along).squaredNorm() > k_straight_m * k_straight_m) {
            return false;
        }
    }
    return true;
}

// Appends the line's segments, simplified. `line_triangle[i]` is the triangle of the piece from
// point i to point i + 1.
void add_line(const Disc& disc, const TraceScratch& scratch, std::vector<DiscSegment>& segments) {
    constexpr std::size_t k_max_merged = 16;  // bounds the cost: is_straight rechecks every point
    std::size_t first = 0;
    for (std::size_t i = 1; i < scratch.line.size(); ++i) {
        const bool goes_on = i + 1 < scratch.line.size() && i + 1 - first <= k_max_merged &&
                             is_straight(scratch.line, first, i + 1);
        if (!goes_on) {
            add_segment(
                {scratch.line[first], scratch.line[i], disc.plane, scratch.line_triangle[first]},
                disc.radius_m, segments);
            first = i;
        }
    }
}

}  // namespace

CrossingSearch find_crossing(const SurfaceGraph& graph, const Disc& disc,
                             std::span<const GraphPoint> starts, TraceScratch& scratch) {
    return CrossingSearcher(graph, disc, scratch).run(starts);
}

std::uint32_t walk_crossing(const SurfaceGraph& graph, const Disc& disc, std::uint32_t triangle,
                            TraceScratch& scratch, std::vector<DiscSegment>& segments) {
    const std::optional<TriangleCut> cut = cut_triangle(graph, disc, triangle);
    if (!cut) {
        return 0;
    }
    // Order of the points: the walk in one direction, reversed; the start triangle's piece; the
    // walk in the other direction.
    scratch.line.clear();
    scratch.line_triangle.clear();
    scratch.line.reserve(k_max_steps + 4);
    scratch.line_triangle.reserve(k_max_steps + 4);
    CutWalk walk(graph, disc, scratch);
    const bool is_closed = walk.run(triangle, *cut, 0);
    std::reverse(scratch.line.begin(), scratch.line.end());
    std::reverse(scratch.line_triangle.begin(), scratch.line_triangle.end());
    scratch.line.push_back(to_disc(disc, cut->point[0]));
    scratch.line_triangle.push_back(triangle);
    scratch.line.push_back(to_disc(disc, cut->point[1]));
    scratch.line_triangle.push_back(triangle);
    if (!is_closed) {
        // In the second walk a piece belongs to the triangle of its end point, so its triangles are
        // stored one index earlier.
        scratch.line_triangle.pop_back();
        walk.run(triangle, *cut, 1);
        scratch.line_triangle.push_back(triangle);
    }
    add_line(disc, scratch, segments);
    return walk.steps() + 1;
}

void add_segment(const DiscSegment& segment, double radius_m, std::vector<DiscSegment>& segments) {
    if (distance_to_origin(segment.a_ds, segment.b_ds) <= radius_m) {
        add_near_part(segment, radius_m, segments);
    }
}

void add_near_part(const DiscSegment& segment, double radius_m,
                   std::vector<DiscSegment>& segments) {
    const Vec2 along_segment = segment.b_ds - segment.a_ds;
    const double longest = 16.0 * radius_m;
    if (along_segment.squaredNorm() <= longest * longest) {
        segments.push_back(segment);
        return;
    }
    const double length = along_segment.norm();
    const Vec2 along = along_segment / length;
    const double middle = std::clamp(-segment.a_ds.dot(along), 0.0, length);
    const double first = std::max(0.0, middle - 0.5 * longest);
    const double last = std::min(length, middle + 0.5 * longest);
    segments.push_back({segment.a_ds + first * along, segment.a_ds + last * along, segment.plane,
                        segment.triangle});
}

}  // namespace handhold
