#include "engine/geometry/surface_graph.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "engine/collision/closest_point.hpp"
#include "engine/core/check.hpp"
#include "engine/geometry/edge_pairs.hpp"
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

void weld_points(SurfaceGraph& graph, const WeldLimits& limits) {
    const std::vector<double> reaches(graph.positions.size(), limits.point_m);
    replace_corners(graph, find_representatives(graph.positions, reaches));
    drop_degenerate(graph);
    compact(graph);
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

double size_of(const SurfaceGraph& graph) {
    if (graph.positions.empty()) {
        return 0.0;
    }
    Vec3 low = graph.positions[0];
    Vec3 high = low;
    for (const Vec3& position : graph.positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    return (high - low).norm();
}

// How far each vertex of an open border may be sewn to; -1 for all others.
std::vector<double> seam_reaches(const SurfaceGraph& graph, const WeldLimits& limits) {
    const double most_m = std::max(limits.seam_m, limits.seam_per_size * size_of(graph));
    std::vector<double> shortest(graph.positions.size(), most_m / limits.seam_per_edge);
    std::vector<bool> open(graph.positions.size(), false);
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      const auto [low, high] = std::pair(edge[0].low, edge[0].high);
                      const double length_m = (graph.positions[low] - graph.positions[high]).norm();
                      for (const std::uint32_t v : {low, high}) {
                          shortest[v] = std::min(shortest[v], length_m);
                          open[v] = open[v] || edge.size() == 1;
                      }
                  });
    for (std::size_t v = 0; v < shortest.size(); ++v) {
        shortest[v] = open[v] ? limits.seam_per_edge * shortest[v] : -1.0;
    }
    return shortest;
}

void sew_borders(SurfaceGraph& graph, const WeldLimits& limits) {
    const std::vector<std::uint32_t> by =
        find_representatives(graph.positions, seam_reaches(graph, limits));
    // What is sewn together lies in the middle of what it was.
    std::vector<Vec3> sums(graph.positions.size(), Vec3::Zero());
    std::vector<double> counts(graph.positions.size(), 0.0);
    for (std::size_t v = 0; v < by.size(); ++v) {
        sums[by[v]] += graph.positions[v];
        counts[by[v]] += 1.0;
        graph.report.sewn_vertices += by[v] != v ? 1U : 0U;
    }
    if (graph.report.sewn_vertices == 0) {
        return;
    }
    for (std::size_t v = 0; v < by.size(); ++v) {
        if (counts[v] > 1.0) {
            graph.positions[v] = sums[v] / counts[v];
        }
    }
    replace_corners(graph, by);
    drop_degenerate(graph);
    compact(graph);
}

void link_neighbours(SurfaceGraph& graph) {
    graph.neighbours.assign(graph.triangles.size(), {k_no_triangle, k_no_triangle, k_no_triangle});
    std::vector<EdgePair> pairs;
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      pairs.clear();
                      pair_half_edges(edge, graph.positions, pairs);
                      for (const EdgePair& pair : pairs) {
                          graph.neighbours[pair.a / 3][pair.a % 3] = pair.b / 3;
                          graph.neighbours[pair.b / 3][pair.b % 3] = pair.a / 3;
                          graph.report.flipped_links += pair.opposed ? 0U : 1U;
                      }
                      graph.report.border_edges +=
                          static_cast<std::uint32_t>(edge.size() - 2 * pairs.size());
                      graph.report.non_manifold_edges += edge.size() > 2 ? 1U : 0U;
                  });
}

std::uint32_t count_parts(const SurfaceGraph& graph) {
    std::vector<bool> seen(graph.triangles.size(), false);
    std::vector<std::uint32_t> open;
    std::uint32_t parts = 0;
    for (std::uint32_t seed = 0; seed < graph.triangles.size(); ++seed) {
        if (seen[seed]) {
            continue;
        }
        ++parts;
        seen[seed] = true;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const std::uint32_t n : graph.neighbours[t]) {
                if (n != k_no_triangle && !seen[n]) {
                    seen[n] = true;
                    open.push_back(n);
                }
            }
        }
    }
    return parts;
}

}  // namespace

SurfaceGraph build_surface_graph(const Mesh& mesh, const WeldLimits& limits) {
    SurfaceGraph graph;
    copy_finite(mesh, graph);
    weld_points(graph, limits);
    drop_duplicates(graph);  // before: they would hide borders
    sew_borders(graph, limits);
    drop_duplicates(graph);
    link_neighbours(graph);
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        graph.normals.push_back(area_vector(corners_of(graph, t)).normalized());
    }
    graph.report.kept = static_cast<std::uint32_t>(graph.triangles.size());
    graph.report.parts = count_parts(graph);
    return graph;
}

}  // namespace handhold
