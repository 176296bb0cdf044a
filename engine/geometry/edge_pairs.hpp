#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Which triangles of a mesh lie on one edge, and which two of them are each other's neighbours.
namespace handhold {

// Edge `id % 3` of triangle `id / 3`: from corner i to corner i + 1.
struct HalfEdge {
    std::uint32_t low = 0;    // vertex
    std::uint32_t high = 0;   // vertex, > low
    std::uint32_t third = 0;  // the triangle's vertex off the edge
    std::uint32_t id = 0;
    bool forward = false;  // runs from low to high
};

// All half-edges sorted by edge, then by third vertex and id: those of one edge come one after
// another. Triangles have three corners that differ.
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
    std::uint32_t a = 0;  // half-edges
    std::uint32_t b = 0;
    bool opposed = true;  // they run against each other, as where both triangles are wound alike
};

// Pairs the half-edges of one edge; appends to `pairs`. Two are neighbours. Of more, first those
// that run against each other and bound the same open wedge on their outer sides: so that what can
// be seen from one point hangs together, two solids that touch in an edge included, and of a sheet
// with two sides each keeps to its own. Then what is left, the flattest first. Half-edges left over
// are borders. `positions`: of vertices; triangles have an area.
void pair_half_edges(std::span<const HalfEdge> edge, std::span<const Vec3> positions,
                     std::vector<EdgePair>& pairs);

}  // namespace handhold
