#include "engine/geometry/surface_graph.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/geometry/border_seams.hpp"
#include "engine/geometry/graph_cleanup.hpp"
#include "engine/geometry/graph_links.hpp"
#include "engine/geometry/weld.hpp"

namespace handhold {
namespace {

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
    drop_not_finite(graph);
}

void replace_corners(SurfaceGraph& graph, const std::vector<std::uint32_t>& by) {
    for (auto& triangle : graph.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = by[corner];
        }
    }
}

// Removes unused vertices; the others keep their order.
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
    clean(graph);  // must come first: duplicates would hide borders
    sew_borders(graph, limits);
    clean(graph);
    cut_borders(graph, limits);
    clean(graph);
    compact(graph);
    link_graph(graph);
    return graph;
}

}  // namespace handhold
