#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh.hpp"

// A mesh as a walkable surface: welded, cleaned, with each triangle's neighbours.
namespace handhold {

inline constexpr std::uint32_t k_no_triangle = ~0U;

struct WeldLimits {
    double point_m = 1e-5;  // vertices nearer than this are merged
    // Open borders are stitched if their vertices are nearer than max(seam_m, seam_per_size * mesh
    // size), but at most seam_per_edge times the shortest edge there.
    double seam_m = 1.5e-4;
    double seam_per_size = 1e-5;
    double seam_per_edge = 0.25;
};

// Counts of the build. kept + not_finite + degenerate + duplicate == triangles + cut_in.
struct SurfaceReport {
    std::uint32_t triangles = 0;  // number of the source's triangles
    std::uint32_t not_finite = 0;
    std::uint32_t degenerate = 0;  // dropped: zero area, or two corners merged by welding
    std::uint32_t duplicate = 0;   // dropped: same corners in the same order as an earlier triangle
    std::uint32_t kept = 0;
    std::uint32_t cut_in = 0;              // triangles added by splits at T-junctions
    std::uint32_t sewn_vertices = 0;       // border vertices merged into another
    std::uint32_t border_edges = 0;        // edges without a neighbour in the graph
    std::uint32_t non_manifold_edges = 0;  // edges of more than two triangles
    std::uint32_t flipped_links = 0;       // pairs of neighbours with opposite windings
    std::uint32_t parts = 0;               // connected components over neighbours
};

// No triangle is degenerate. If triangle a is a neighbour of b, b is one of a, and they share the
// edge's two vertices. Mixed winding is preserved: a neighbour may have the opposite winding.
struct SurfaceGraph {
    std::vector<Vec3> positions;  // welded
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // [i]: the triangle across the edge from corner i to i + 1; k_no_triangle at a border.
    std::vector<std::array<std::uint32_t, 3>> neighbours;
    std::vector<Vec3> normals;                   // unit, from the triangle's winding
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
