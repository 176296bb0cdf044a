#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

// What makes a surface graph of welded triangles: links, normals, parts, one winding a part.
namespace handhold {

// Writes neighbours, normals and the report's numbers of them from positions and triangles.
// Precondition: triangles have an area and three corners.
void link_graph(SurfaceGraph& graph);

struct GraphComponents {
    std::vector<std::uint32_t> of_triangle;
    std::uint32_t count = 0;
};
// Triangles that hang together over neighbours; parts are numbered by their first triangle.
GraphComponents find_components(const SurfaceGraph& graph);

// Winds the triangles of each sheet alike (a sheet hangs together over edges of two triangles),
// turning those that have the lesser area; drops what is there twice then, links again. Where a
// sheet has but one side (a Moebius strip) some links stay flipped. Returns how many triangles were
// turned.
std::uint32_t orient_consistently(SurfaceGraph& graph);

// Turns every triangle of the closed parts (no border, wound alike) where these together hold a
// negative volume, as in a mesh that is inside out: outer sides face out then. A hollow's inner
// wall keeps facing the hollow. Returns how many triangles were turned.
std::uint32_t orient_outward(SurfaceGraph& graph);

}  // namespace handhold
