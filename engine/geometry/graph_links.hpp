#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

// Turns welded triangles into a surface graph: neighbours, normals, components and consistent
// winding.
namespace handhold {

// Computes neighbours, normals and the report's counts from positions and triangles. Precondition:
// no degenerate triangle.
void link_graph(SurfaceGraph& graph);

struct GraphComponents {
    std::vector<std::uint32_t> of_triangle;
    std::uint32_t count = 0;
};
// Connected components over neighbours, numbered by their first triangle.
GraphComponents find_components(const SurfaceGraph& graph);

// Winds the triangles of each sheet alike; a sheet is connected over edges of exactly two
// triangles. Flips the orientation with the smaller total area, drops new duplicates and links the
// graph again. A one-sided sheet (Moebius strip) keeps some flipped links. Returns the number of
// triangles turned.
std::uint32_t orient_consistently(SurfaceGraph& graph);

// Flips all closed components (no border, consistent winding) if their signed volumes sum to less
// than 0, as in an inside-out mesh. Outer sides then face out, and the inner wall of a hollow keeps
// facing the hollow. Returns the number of triangles turned.
std::uint32_t orient_outward(SurfaceGraph& graph);

}  // namespace handhold
