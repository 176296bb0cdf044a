#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

// Completes a surface graph of welded triangles: computes neighbours, normals and components, and
// makes the winding consistent.
namespace handhold {

// Computes neighbours, normals and the report's counts from positions and triangles. Precondition:
// no degenerate triangle.
void link_graph(SurfaceGraph& graph);

struct GraphComponents {
    std::vector<std::uint32_t> of_triangle;
    std::uint32_t count = 0;
};
// Connected components over neighbours, numbered in the order of their first triangles.
GraphComponents find_components(const SurfaceGraph& graph);

// Gives all triangles of a sheet the same winding. Sheets are connected over edges that exactly two
// triangles share. Flips the triangles of the winding with the smaller total area, drops new
// duplicates and calls link_graph. In a one-sided sheet (Moebius strip) some neighbours keep
// opposite windings. Returns the number of triangles flipped.
std::uint32_t orient_consistently(SurfaceGraph& graph);

// Flips all closed components (no border, consistent winding) if their signed volumes sum to less
// than 0, as in an inside-out mesh. Then outer sides face outwards, and the inner wall of a hollow
// still faces the hollow. Returns the number of triangles flipped.
std::uint32_t orient_outward(SurfaceGraph& graph);

}  // namespace handhold
