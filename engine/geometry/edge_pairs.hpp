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
    std::uint32_t third = 0;  // the triangle's vertex off the edge
    std::uint32_t id = 0;
    bool forward = false;  // runs from low to high
};

// All half-edges sorted by edge, then third vertex, then id; half-edges of one edge are adjacent.
// Precondition: each triangle has three distinct corners.
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
    bool opposed = true;  // opposite directions: the triangles are wound alike
};

// Pairs the half-edges of one edge and appends the pairs. Two half-edges are neighbours. Of more
// than two, opposed half-edges that bound the same open wedge on their outer sides are paired
// first. So surfaces visible from one point stay connected, also where two solids touch at an edge,
// and each side of a two-sided sheet keeps to itself. The rest are paired flattest first; an odd
// one out is a border. `positions` are the vertices' positions. Precondition: triangles are not
// degenerate.
void pair_half_edges(std::span<const HalfEdge> edge, std::span<const Vec3> positions,
                     std::vector<EdgePair>& pairs);

}  // namespace handhold
