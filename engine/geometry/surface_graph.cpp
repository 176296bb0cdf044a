#include "engine/geometry/surface_graph.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "engine/collision/closest_point.hpp"
#include "engine/core/check.hpp"
#include "engine/geometry/border_seams.hpp"
#include "engine/geometry/edge_pairs.hpp"
#include "engine/geometry/graph_links.hpp"
#include "engine/geometry/weld.hpp"

namespace handhold {
namespace {

Corners corners_of(const SurfaceGraph& graph, std::size_t t) {
    const auto& [a, b, c] = graph.triangles[t];
    return {graph.positions[a], graph.positions[b], graph.positions[c]};
}

// Keeps the triangles for which keep(t) is true, in their order, and counts the others.
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

void copy_finite(const Mesh& mesh, SurfaceGraph& graph) {
    graph.positions = mesh.positions;
    graph.triangles = mesh.triangles;
    graph.source_triangle.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        graph.source_triangle[t] = t;
        for (const std::uint32_t index : mesh.triangles[t]) {
            HH_CHECK(index < mesh.positions.size(), "an index is out of range in triangle", t);
        }
    }
    graph.report.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
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

void replace_corners(SurfaceGraph& graph, const std::vector<std::uint32_t>& by) {
    for (auto& triangle : graph.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = by[corner];
        }
    }
}

// Vertices that no triangle has are left out; the others keep their order.
void compact(SurfaceGraph& graph) {
    constexpr std::uint32_t k_unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(graph.positions.size(), k_unused);
    for (const auto& triangle : graph.triangles) {
        for (const std::uint32_t corner : triangle) {
            place[corner] = 0;
        }
    }
    std::uint32_t used = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] != k_unused) {
            graph.positions[used] = graph.positions[v];
            place[v] = used++;
        }
    }
    graph.positions.resize(used);
    graph.positions.shrink_to_fit();
    replace_corners(graph, place);
}

void drop_duplicates(SurfaceGraph& graph) {
    std::vector<bool> duplicate(graph.triangles.size(), false);
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      // Those with one third vertex come one after another, by number.
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

void clean(SurfaceGraph& graph) {
    drop_degenerate(graph);
    drop_duplicates(graph);
}

}  // namespace

SurfaceGraph build_surface_graph(const Mesh& mesh, const WeldLimits& limits) {
    SurfaceGraph graph;
    copy_finite(mesh, graph);
    const std::vector<double> reaches(graph.positions.size(), limits.point_m);
    replace_corners(graph, find_representatives(graph.positions, reaches));
    clean(graph);  // before: what is twice would hide borders
    sew_borders(graph, limits);
    clean(graph);
    cut_borders(graph, limits);
    clean(graph);
    compact(graph);
    link_graph(graph);
    return graph;
}

}  // namespace handhold
