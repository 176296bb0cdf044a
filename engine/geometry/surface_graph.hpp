#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/mesh.hpp"

// A mesh as a surface that one can walk on: welded, cleaned, each triangle with its neighbours.
namespace handhold {

inline constexpr std::uint32_t k_no_triangle = ~0U;

struct WeldLimits {
    double point_m = 1e-5;  // nearer points are one
    // Open borders are sewn together where their vertices are as near as this, or as seam_per_size
    // of the mesh's size if that is more, but never beyond seam_per_edge of the shortest edge
    // there.
    double seam_m = 1.5e-4;
    double seam_per_size = 1e-5;
    double seam_per_edge = 0.25;
};

// What became of the mesh: kept + not_finite + degenerate + duplicate == triangles + cut_in.
struct SurfaceReport {
    std::uint32_t triangles = 0;   // of the source
    std::uint32_t not_finite = 0;  // dropped: a corner is NaN or infinite
    std::uint32_t degenerate = 0;  // dropped: no area, or two corners are one after welding
    std::uint32_t duplicate = 0;   // dropped: the same corners in the same order as an earlier one
    std::uint32_t kept = 0;
    std::uint32_t cut_in = 0;         // more triangles by cuts where a vertex lay on an open edge
    std::uint32_t sewn_vertices = 0;  // of open borders, joined to another
    std::uint32_t border_edges = 0;   // of the graph: edges without a neighbour
    std::uint32_t non_manifold_edges = 0;  // of more than two triangles
    std::uint32_t flipped_links = 0;       // neighbours that are wound against each other
    std::uint32_t parts = 0;               // that hang together over neighbours
};

// Triangles have an area and corners that differ; links are mutual, and both triangles have the
// edge's two vertices. Mixed winding stays as it is: a neighbour may be wound the other way.
struct SurfaceGraph {
    std::vector<Vec3> positions;  // welded
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 3>>
        neighbours;             // over the edge from corner i to i + 1; k_no_triangle at a border
    std::vector<Vec3> normals;  // unit, by the triangle's winding
    std::vector<std::uint32_t> source_triangle;  // in the mesh it was built from, ascending
    SurfaceReport report;
};

inline Corners corners_of(const SurfaceGraph& graph, std::size_t triangle) {
    const auto& [a, b, c] = graph.triangles[triangle];
    return {graph.positions[a], graph.positions[b], graph.positions[c]};
}

// Any mesh whose indices are in range (PreconditionError otherwise): soup, holes, slivers,
// non-manifold edges (edge_pairs.hpp says who is whose neighbour), vertices that are not finite.
// Triangles keep their order and their first corner. The same input gives the same bits on every
// compiler.
SurfaceGraph build_surface_graph(const Mesh& mesh, const WeldLimits& limits = {});

}  // namespace handhold
