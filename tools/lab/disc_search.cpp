#include "tools/lab/disc_search.hpp"

#include <limits>
#include <vector>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/disc_cut.hpp"

namespace handhold::lab {
namespace {

// Visits triangles in the order in which they are found, until `max_pops` are visited or none in
// reach is left.
CrossingSearch search_breadth_first(const SurfaceGraph& graph, const Disc& disc,
                                    std::span<const GraphPoint> starts, std::uint32_t max_pops,
                                    bool stops_at_hit) {
    CrossingSearch found;
    std::vector<GraphPoint> open;
    std::vector<bool> seen(graph.triangles.size(), false);
    const auto push = [&](std::uint32_t triangle, const Vec3& point) {
        if (triangle != k_no_triangle && !seen[triangle]) {
            seen[triangle] = true;
            open.push_back({triangle, point});
        }
    };
    for (const GraphPoint& start : starts) {
        push(start.triangle, start.point);
    }
    while (found.pops < open.size() && found.pops < max_pops) {
        const GraphPoint node = open[found.pops++];
        const auto cut = cut_triangle(graph, disc, node.triangle);
        if (found.triangle == k_no_triangle && cut && reaches_disc(disc, *cut)) {
            found.triangle = node.triangle;
            found.point = closest_on_segment(node.point, cut->point[0], cut->point[1]);
            if (stops_at_hit) {
                break;
            }
        }
        const auto& corners = graph.triangles[node.triangle];
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (is_edge_in_reach(graph, disc, node.triangle, i)) {
                push(graph.neighbours[node.triangle][i],
                     closest_on_segment(node.point, graph.positions[corners[i]],
                                        graph.positions[corners[(i + 1) % 3]]));
            }
        }
    }
    return found;
}

}  // namespace

CrossingSearch find_crossing_in(SearchOrder order, const SurfaceGraph& graph, const Disc& disc,
                                std::span<const GraphPoint> starts, TraceScratch& scratch) {
    switch (order) {
        case SearchOrder::best_first:
            return find_crossing(graph, disc, starts, scratch);
        case SearchOrder::breadth_first:
            return search_breadth_first(graph, disc, starts, k_max_pops, true);
        case SearchOrder::flood:
            break;
    }
    return search_breadth_first(graph, disc, starts, std::numeric_limits<std::uint32_t>::max(),
                                false);
}

}  // namespace handhold::lab
