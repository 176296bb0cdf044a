#include "engine/geometry/graph_links.hpp"

#include <span>
#include <utility>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/edge_pairs.hpp"
#include "engine/geometry/graph_cleanup.hpp"

namespace handhold {
namespace {

Vec3 area_of(const SurfaceGraph& graph, std::size_t t) {
    const auto& [a, b, c] = graph.triangles[t];
    return area_vector({graph.positions[a], graph.positions[b], graph.positions[c]});
}

// Swaps a triangle's last two corners, so that its first corner stays. Its neighbours move with
// their edges.
void flip(SurfaceGraph& graph, std::size_t t) {
    std::swap(graph.triangles[t][1], graph.triangles[t][2]);
    std::swap(graph.neighbours[t][0], graph.neighbours[t][2]);
    graph.normals[t] = -graph.normals[t];
}

// True if the triangle has the directed edge `from` -> `to`.
bool has_directed_edge(const std::array<std::uint32_t, 3>& triangle, std::uint32_t from,
                       std::uint32_t to) {
    return (triangle[0] == from && triangle[1] == to) ||
           (triangle[1] == from && triangle[2] == to) || (triangle[2] == from && triangle[0] == to);
}

// Each triangle's neighbours over edges that exactly two triangles share; k_no_triangle over other
// edges.
std::vector<std::array<std::uint32_t, 3>> sheet_neighbours(const SurfaceGraph& graph) {
    std::vector<std::array<std::uint32_t, 3>> sheet(graph.triangles.size(),
                                                    {k_no_triangle, k_no_triangle, k_no_triangle});
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      if (edge.size() == 2) {
                          sheet[edge[0].id / 3][edge[0].id % 3] = edge[1].id / 3;
                          sheet[edge[1].id / 3][edge[1].id % 3] = edge[0].id / 3;
                      }
                  });
    return sheet;
}

}  // namespace

void link_graph(SurfaceGraph& graph) {
    SurfaceReport& report = graph.report;
    report.border_edges = report.non_manifold_edges = report.flipped_links = 0;
    graph.neighbours.assign(graph.triangles.size(), {k_no_triangle, k_no_triangle, k_no_triangle});
    std::vector<EdgePair> pairs;
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      pairs.clear();
                      pair_half_edges(edge, graph.positions, pairs);
                      for (const EdgePair& pair : pairs) {
                          graph.neighbours[pair.a / 3][pair.a % 3] = pair.b / 3;
                          graph.neighbours[pair.b / 3][pair.b % 3] = pair.a / 3;
                          report.flipped_links += pair.opposed ? 0U : 1U;
                      }
                      report.border_edges +=
                          static_cast<std::uint32_t>(edge.size() - 2 * pairs.size());
                      report.non_manifold_edges += edge.size() > 2 ? 1U : 0U;
                  });
    graph.normals.resize(graph.triangles.size());
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        graph.normals[t] = area_of(graph, t).normalized();
    }
    report.kept = static_cast<std::uint32_t>(graph.triangles.size());
    report.parts = find_components(graph).count;
}

GraphComponents find_components(const SurfaceGraph& graph) {
    GraphComponents parts;
    parts.of_triangle.assign(graph.triangles.size(), k_no_triangle);
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < graph.triangles.size(); ++seed) {
        if (parts.of_triangle[seed] != k_no_triangle) {
            continue;
        }
        parts.of_triangle[seed] = parts.count;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const std::uint32_t n : graph.neighbours[t]) {
                if (n != k_no_triangle && parts.of_triangle[n] == k_no_triangle) {
                    parts.of_triangle[n] = parts.count;
                    open.push_back(n);
                }
            }
        }
        ++parts.count;
    }
    return parts;
}

std::uint32_t orient_consistently(SurfaceGraph& graph) {
    if (graph.report.flipped_links == 0) {
        return 0;
    }
    const std::vector<std::array<std::uint32_t, 3>> sheet_neighbour = sheet_neighbours(graph);
    enum class Side : std::uint8_t { unseen, kept, turned };
    std::vector<Side> sides(graph.triangles.size(), Side::unseen);
    std::vector<std::uint32_t> sheet;
    std::uint32_t turned = 0;
    for (std::uint32_t seed = 0; seed < graph.triangles.size(); ++seed) {
        if (sides[seed] != Side::unseen) {
            continue;
        }
        sides[seed] = Side::kept;
        sheet.assign(1, seed);
        double balance = 0.0;  // area with the seed's winding, minus area with the opposite winding
        for (std::size_t i = 0; i < sheet.size(); ++i) {
            const std::uint32_t t = sheet[i];
            balance += (sides[t] == Side::kept ? 1.0 : -1.0) * area_of(graph, t).norm();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t n = sheet_neighbour[t][k];
                if (n == k_no_triangle || sides[n] != Side::unseen) {
                    continue;
                }
                const bool alike = has_directed_edge(
                    graph.triangles[n], graph.triangles[t][(k + 1) % 3], graph.triangles[t][k]);
                sides[n] = alike == (sides[t] == Side::kept) ? Side::kept : Side::turned;
                sheet.push_back(n);
            }
        }
        for (const std::uint32_t t : sheet) {
            if ((sides[t] == Side::turned) == (balance >= 0.0)) {
                flip(graph, t);
                ++turned;
            }
        }
    }
    drop_duplicates(graph);  // a flipped triangle may now equal its former reverse side
    link_graph(graph);       // the pairs at non-manifold edges depend on the winding
    return turned;
}

std::uint32_t orient_outward(SurfaceGraph& graph) {
    const GraphComponents parts = find_components(graph);
    std::vector<bool> closed(parts.count, true);
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t n = graph.neighbours[t][k];
            const auto& triangle = graph.triangles[t];
            if (n == k_no_triangle ||
                !has_directed_edge(graph.triangles[n], triangle[(k + 1) % 3], triangle[k])) {
                closed[parts.of_triangle[t]] = false;
            }
        }
    }
    double volume = 0.0;  // six times the volume, relative to the first vertex
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        if (closed[parts.of_triangle[t]]) {
            volume += (graph.positions[graph.triangles[t][0]] - graph.positions[0])
                          .dot(area_of(graph, t));
        }
    }
    std::uint32_t turned = 0;
    for (std::size_t t = 0; volume < 0.0 && t < graph.triangles.size(); ++t) {
        if (closed[parts.of_triangle[t]]) {
            flip(graph, t);
            ++turned;
        }
    }
    if (turned > 0) {
        drop_duplicates(graph);
        link_graph(graph);
    }
    return turned;
}

}  // namespace handhold
