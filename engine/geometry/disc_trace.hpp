#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/surface_graph.hpp"

// Cuts a surface with a disc: the plane in which a chain closes, out to where it can reach.
// Sources: talk rows 11 to 13; A*: Hart, Nilsson and Raphael 1968.
namespace handhold {

// In the surface's frame.
struct Disc {
    Vec3 center = Vec3::Zero();
    Vec3 x_axis = Vec3::UnitX();  // unit: disc space's +X
    Vec3 y_axis = Vec3::UnitY();  // unit, across x_axis
    Vec3 normal = Vec3::UnitZ();  // unit: x_axis x y_axis
    double radius_m = 0.1;
    std::uint32_t plane = 0;  // given to its segments
};

inline Vec2 to_disc(const Disc& disc, const Vec3& point) {
    const Vec3 from_center = point - disc.center;
    return {from_center.dot(disc.x_axis), from_center.dot(disc.y_axis)};
}

struct GraphPoint {
    std::uint32_t triangle = k_no_triangle;  // none: no point
    Vec3 point = Vec3::Zero();               // on it
};

enum class SearchOrder : std::uint8_t {
    best_first,     // A*: what is near the start and leads towards the disc first
    breadth_first,  // as a flood that stops where it finds; for comparison
    flood,          // all that is in reach, however much that is; for comparison
};

struct CrossingSearch {
    std::uint32_t triangle = k_no_triangle;  // the first whose cut comes into the disc
    Vec3 point = Vec3::Zero();               // of that cut, where the search came in
    std::uint32_t pops = 0;                  // triangles looked at
};

// Keeps its memory between calls.
struct TraceScratch {
    struct Node {
        double cost_m = 0.0;  // so far and still to go
        double path_m = 0.0;
        std::uint32_t triangle = 0;
        std::uint32_t order = 0;  // of insertion: breaks ties
        Vec3 point = Vec3::Zero();
    };
    std::vector<Node> open;
    std::vector<std::uint32_t> seen;  // hashed
    std::vector<Vec2> line;
    std::vector<std::uint32_t> line_triangle;
};

inline constexpr std::uint32_t k_max_pops = 128;
inline constexpr std::uint32_t k_max_starts = 16;
inline constexpr std::uint32_t k_max_steps = 512;

// From all `starts` at once over neighbours to the first triangle that the disc cuts. Its distance
// is that of a path over the closest points of the edges in between, from its own start; what is
// left is guessed as twice the distance to the plane. Gives up after k_max_pops, which all starts
// share, or where all that is left is farther than 30 mm outside of the disc. A flood finds the
// same as breadth_first, but looks at the rest as well; what it has seen takes memory by the
// surface's size. Preconditions: at most k_max_starts, their triangles the graph's, or none.
CrossingSearch find_crossing(const SurfaceGraph& graph, const Disc& disc,
                             std::span<const GraphPoint> starts, SearchOrder order,
                             TraceScratch& scratch);

// From a triangle that the disc cuts along the cut both ways, until it leaves the disc, ends, or
// closes; the pieces within the disc, with corners that leave the line by less than 0.25 mm left
// out, are added to `segments`. Returns the triangles walked. A corner on the plane counts as on
// its normal's side, so that every cut has two ends.
std::uint32_t walk_crossing(const SurfaceGraph& graph, const Disc& disc, std::uint32_t triangle,
                            TraceScratch& scratch, std::vector<DiscSegment>& segments);

// Adds the segment if any of it is within the radius about the disc's centre: of what is very long,
// what is near.
void add_segment(const DiscSegment& segment, double radius_m, std::vector<DiscSegment>& segments);

// Adds what is near of a segment that is known to come near: distances to it are found in floats.
void add_near_part(const DiscSegment& segment, double radius_m, std::vector<DiscSegment>& segments);

}  // namespace handhold
