#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Groups a mesh's half-edges by edge and pairs neighbouring triangles.
namespace handhold {

// Half-edge of triangle `id / 3` from its corner `id % 3` to the next corner.
struct HalfEdge {
    std::uint32_t low = 0;    // vertex
    std::uint32_t high = 0;   // vertex, > low
    std::uint32_t third = 0;  // vertex of the triangle that is not on the edge
    std::uint32_t id = 0;
    bool forward = false;  // runs from low to high
};

// All half-edges, sorted by edge, then by third vertex, then by id: half-edges of one edge follow
// each other. Precondition: each triangle has three distinct corners.
std::vector<HalfEdge> sorted_half_edges(std::size_t vertex_count,
                                        std::span<const std::array<std::uint32_t, 3>> triangles);

// Calls visit(std::span<const HalfEdge>) for each edge.
template <typename Visit>
void for_each_edge(std::span<const HalfEdge> sorted, const Visit& visit) {
    for (std::size_t first = 0; first < sorted.size();) {
        std::size_t last = first + 1;
        while (last < sorted.size() && sorted[last].low == sorted[first].low &&
               sorted[last].high == sorted[first].high) {
            ++last;
        }
        visit(sorted.subspan(first, last - first));
        first = last;
    }
}

struct EdgePair {
    std::uint32_t a = 0;  // half-edge ids
    std::uint32_t b = 0;
    bool opposed = true;  // opposite directions: the triangles have the same winding
};

// Pairs the half-edges of one edge and appends the pairs. Two half-edges form one pair. If there
// are more, opposed half-edges are paired first if their triangles' outer sides bound the same open
// wedge. So surfaces visible from one point stay connected, even where two solids touch at an edge,
// and the two sides of a two-sided sheet stay separate. The other half-edges are paired flattest
// first; a half-edge without a partner is a border. `positions` are the vertices' positions.
// Precondition: no triangle is degenerate.
void pair_half_edges(std::span<const HalfEdge> edge, std::span<const Vec3> positions,
                     std::vector<EdgePair>& pairs);

}  // namespace handhold
