#include "engine/geometry/graph_cleanup.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/edge_pairs.hpp"

namespace handhold {
namespace {

// Keeps the triangles for which keep(t) is true, in order. Adds the number of the others to
// `dropped`.
template <typename Keep>
void filter(SurfaceGraph& graph, std::uint32_t& dropped, const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        if (keep(t)) {
            graph.triangles[kept] = graph.triangles[t];
            graph.source_triangle[kept] = graph.source_triangle[t];
            ++kept;
        } else {
            ++dropped;
        }
    }
    graph.triangles.resize(kept);
    graph.source_triangle.resize(kept);
}

}  // namespace

void drop_not_finite(SurfaceGraph& graph) {
    filter(graph, graph.report.not_finite, [&](std::size_t t) {
        return std::all_of(graph.triangles[t].begin(), graph.triangles[t].end(),
                           [&](std::uint32_t v) { return is_finite(graph.positions[v]); });
    });
}

void drop_degenerate(SurfaceGraph& graph) {
    filter(graph, graph.report.degenerate, [&](std::size_t t) {
        const auto& [a, b, c] = graph.triangles[t];
        return a != b && b != c && c != a && !area_vector(corners_of(graph, t)).isZero(0.0);
    });
}

void drop_duplicates(SurfaceGraph& graph) {
    std::vector<bool> duplicate(graph.triangles.size(), false);
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      // The span is sorted by third vertex, then id: half-edges of triangles with
                      // the same corners follow each other.
                      std::array<bool, 2> seen = {};
                      for (std::size_t i = 0; i < edge.size(); ++i) {
                          if (i == 0 || edge[i].third != edge[i - 1].third) {
                              seen = {};
                          }
                          bool& before = seen[edge[i].forward ? 1 : 0];
                          if (before) {
                              duplicate[edge[i].id / 3] = true;
                          }
                          before = true;
                      }
                  });
    filter(graph, graph.report.duplicate, [&](std::size_t t) { return !duplicate[t]; });
}

}  // namespace handhold
