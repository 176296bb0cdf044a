#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/mesh.hpp"

// A mesh as a walkable surface: welded, cleaned, with each triangle's neighbours.
namespace handhold {

inline constexpr std::uint32_t k_no_triangle = ~0U;

struct WeldLimits {
    double point_m = 1e-5;  // vertices nearer than this are merged
    // Open borders are stitched where their vertices are as near as max(seam_m, seam_per_size *
    // mesh size), but at most seam_per_edge times the shortest edge there.
    double seam_m = 1.5e-4;
    double seam_per_size = 1e-5;
    double seam_per_edge = 0.25;
};

// Counts of the build: kept + not_finite + degenerate + duplicate == triangles + cut_in.
struct SurfaceReport {
    std::uint32_t triangles = 0;  // of the source
    std::uint32_t not_finite = 0;
    std::uint32_t degenerate = 0;  // dropped: zero area, or two corners merged by welding
    std::uint32_t duplicate = 0;   // dropped: same corners in the same order as an earlier triangle
    std::uint32_t kept = 0;
    std::uint32_t cut_in = 0;              // triangles added by splits at T-junctions
    std::uint32_t sewn_vertices = 0;       // border vertices merged into another
    std::uint32_t border_edges = 0;        // edges without a neighbour in the graph
    std::uint32_t non_manifold_edges = 0;  // edges of more than two triangles
    std::uint32_t flipped_links = 0;       // neighbours wound against each other
    std::uint32_t parts = 0;               // connected components over neighbours
};

// Triangles are not degenerate. Links are mutual, and both triangles share the edge's two vertices.
// Mixed winding is preserved: a neighbour may be wound the other way.
struct SurfaceGraph {
    std::vector<Vec3> positions;  // welded
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 3>>
        neighbours;             // over the edge from corner i to i + 1; k_no_triangle at a border
    std::vector<Vec3> normals;  // unit, from the triangle's winding
    std::vector<std::uint32_t> source_triangle;  // index in the source mesh, ascending
    SurfaceReport report;
};

inline Corners corners_of(const SurfaceGraph& graph, std::size_t triangle) {
    const auto& [a, b, c] = graph.triangles[triangle];
    return {graph.positions[a], graph.positions[b], graph.positions[c]};
}

// Accepts any mesh with indices in range (else PreconditionError): soup, holes, slivers,
// non-manifold edges (edge_pairs.hpp defines the neighbours), non-finite vertices. Triangles keep
// their order and first corner. Results are bitwise equal on every compiler.
SurfaceGraph build_surface_graph(const Mesh& mesh, const WeldLimits& limits = {});

}  // namespace handhold
