#include "engine/geometry/border_seams.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/edge_pairs.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "engine/geometry/weld.hpp"

namespace handhold {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double k_widest_seam_m = 1e-3;
// An edge that is shorter than both other edges by this factor does not limit the seam's width.
// Jittered meshes have degenerate triangles with edges as short as the jitter.
constexpr double k_needle = 8.0;

struct Borders {
    std::vector<HalfEdge> edges;    // edges with one triangle
    std::vector<double> reaches_m;  // merge distance of each vertex; -1: vertex off the borders
};

double size_of(const std::vector<Vec3>& positions) {
    if (positions.empty()) {
        return 0.0;
    }
    Vec3 low = positions[0];
    Vec3 high = low;
    for (const Vec3& position : positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    return (high - low).norm();
}

double widest_seam(const SurfaceGraph& graph, const WeldLimits& limits) {
    const double by_size =
        std::min(limits.seam_per_size * size_of(graph.positions), k_widest_seam_m);
    return std::max(limits.seam_m, by_size);
}

// Largest seam width per vertex: seam_per_edge times its shortest edge, without needle edges.
std::vector<double> fineness(const SurfaceGraph& graph, const WeldLimits& limits, double max_m) {
    std::vector<double> result(graph.positions.size(), max_m);
    for (const Triangle& triangle : graph.triangles) {
        std::array<double, 3> lengths = {};
        for (std::size_t i = 0; i < 3; ++i) {
            lengths[i] =
                (graph.positions[triangle[(i + 1) % 3]] - graph.positions[triangle[i]]).norm();
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const double others = std::min(lengths[(i + 1) % 3], lengths[(i + 2) % 3]);
            if (k_needle * lengths[i] < others) {
                continue;
            }
            for (const std::uint32_t v : {triangle[i], triangle[(i + 1) % 3]}) {
                result[v] = std::min(result[v], limits.seam_per_edge * lengths[i]);
            }
        }
    }
    return result;
}

Borders find_borders(const SurfaceGraph& graph, const WeldLimits& limits) {
    Borders borders;
    const double max_m = widest_seam(graph, limits);
    if (!(max_m > 0.0)) {
        return borders;
    }
    const std::vector<double> fine = fineness(graph, limits, max_m);
    borders.reaches_m.assign(graph.positions.size(), -1.0);
    for_each_edge(sorted_half_edges(graph.positions.size(), graph.triangles),
                  [&](std::span<const HalfEdge> edge) {
                      if (edge.size() == 1) {
                          borders.edges.push_back(edge[0]);
                          for (const std::uint32_t v : {edge[0].low, edge[0].high}) {
                              borders.reaches_m[v] = fine[v];
                          }
                      }
                  });
    return borders;
}

// A vertex that lies on an open edge of a triangle.
struct SeamCut {
    std::uint32_t triangle = 0;
    std::uint32_t side = 0;
    double along = 0.0;  // fraction from corner `side` to the next corner
    std::uint32_t vertex = 0;
};

std::vector<SeamCut> find_cuts(const SurfaceGraph& graph, const Borders& borders) {
    std::vector<Triangle> lines;
    for (const HalfEdge& edge : borders.edges) {
        lines.push_back({edge.low, edge.high, edge.high});
    }
    const TriangleBvh bvh(graph.positions, lines);
    std::vector<SeamCut> cuts;
    for (std::uint32_t v = 0; v < borders.reaches_m.size(); ++v) {
        const double reach = borders.reaches_m[v];
        bvh.visit_in_sphere(graph.positions[v], reach, [&](std::uint32_t i) {
            const HalfEdge& edge = borders.edges[i];
            if (v == edge.low || v == edge.high || v == edge.third) {
                return;
            }
            const Triangle& triangle = graph.triangles[edge.id / 3];
            const std::uint32_t side = edge.id % 3;
            const Vec3& from = graph.positions[triangle[side]];
            const Vec3 edge_m = graph.positions[triangle[(side + 1) % 3]] - from;
            const double along = (graph.positions[v] - from).dot(edge_m) / edge_m.squaredNorm();
            // A vertex nearer than this to an end of the edge is merged with that end instead of
            // splitting the edge.
            const double end_share = reach / edge_m.norm();
            if (along > end_share && along < 1.0 - end_share) {
                cuts.push_back({edge.id / 3, side, along, v});
            }
        });
    }
    std::sort(cuts.begin(), cuts.end(), [](const SeamCut& a, const SeamCut& b) {
        return std::tie(a.triangle, a.side, a.along, a.vertex) <
               std::tie(b.triangle, b.side, b.along, b.vertex);
    });
    return cuts;
}

// A piece of a split triangle. rest_of[i]: number of the original side of which edge i is the part
// that later cuts may split; k_no_side if edge i is not such a part.
struct Piece {
    Triangle corners;
    std::array<std::uint32_t, 3> rest_of;
};
constexpr std::uint32_t k_no_side = 3;

Vec3 area_of(const SurfaceGraph& graph, const Triangle& corners) {
    return area_vector(
        {graph.positions[corners[0]], graph.positions[corners[1]], graph.positions[corners[2]]});
}

// Splits the piece with the uncut part of side `cut.side`. Cuts of one side must come in ascending
// order. Returns false and changes nothing if a new piece would be flipped or degenerate.
bool cut_piece(const SurfaceGraph& graph, const Vec3& area, const SeamCut& cut,
               std::vector<Piece>& pieces) {
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (pieces[p].rest_of[k] != cut.side) {
                continue;
            }
            const Piece old = pieces[p];
            const std::uint32_t from = old.corners[k];
            const std::uint32_t to = old.corners[(k + 1) % 3];
            const std::uint32_t apex = old.corners[(k + 2) % 3];
            const Piece done = {{from, cut.vertex, apex},
                                {k_no_side, k_no_side, old.rest_of[(k + 2) % 3]}};
            const Piece rest = {{cut.vertex, to, apex},
                                {cut.side, old.rest_of[(k + 1) % 3], k_no_side}};
            if (cut.vertex == from || cut.vertex == to || cut.vertex == apex ||
                !(area_of(graph, done.corners).dot(area) > 0.0) ||
                !(area_of(graph, rest.corners).dot(area) > 0.0)) {
                return false;
            }
            pieces[p] = done;
            pieces.push_back(rest);
            return true;
        }
    }
    return false;
}

}  // namespace

void sew_borders(SurfaceGraph& graph, const WeldLimits& limits) {
    const Borders borders = find_borders(graph, limits);
    if (borders.edges.empty()) {
        return;
    }
    const std::vector<std::uint32_t> by = find_representatives(graph.positions, borders.reaches_m);
    std::vector<Vec3> sums(graph.positions.size(), Vec3::Zero());
    std::vector<double> counts(graph.positions.size(), 0.0);
    for (std::size_t v = 0; v < by.size(); ++v) {
        sums[by[v]] += graph.positions[v];
        counts[by[v]] += 1.0;
        graph.report.sewn_vertices += by[v] != v ? 1U : 0U;
    }
    for (std::size_t v = 0; v < by.size(); ++v) {
        if (counts[v] > 1.0) {
            graph.positions[v] = sums[v] / counts[v];
        }
    }
    for (Triangle& triangle : graph.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = by[corner];
        }
    }
}

void cut_borders(SurfaceGraph& graph, const WeldLimits& limits) {
    const Borders borders = find_borders(graph, limits);
    const std::vector<SeamCut> cuts = find_cuts(graph, borders);
    if (cuts.empty()) {
        return;
    }
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> sources;
    std::vector<Piece> pieces;
    std::size_t next = 0;
    for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
        pieces.assign(1, {graph.triangles[t], {0, 1, 2}});
        const Vec3 area = area_of(graph, graph.triangles[t]);
        for (; next < cuts.size() && cuts[next].triangle == t; ++next) {
            graph.report.cut_in += cut_piece(graph, area, cuts[next], pieces) ? 1U : 0U;
        }
        for (const Piece& piece : pieces) {
            triangles.push_back(piece.corners);
            sources.push_back(graph.source_triangle[t]);
        }
    }
    graph.triangles = std::move(triangles);
    graph.source_triangle = std::move(sources);
}

}  // namespace handhold
