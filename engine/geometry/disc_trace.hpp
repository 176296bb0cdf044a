#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/surface_graph.hpp"

// Cuts a surface with a disc: the plane in which a chain closes, bounded by the chain's reach.
// Sources: talk rows 11 to 13; A* after Hart, Nilsson and Raphael 1968.
namespace handhold {

// In the surface's frame. Disc space has its origin at `center`.
struct Disc {
    Vec3 center = Vec3::Zero();
    Vec3 x_axis = Vec3::UnitX();  // unit: disc space's +X
    Vec3 y_axis = Vec3::UnitY();  // unit, across x_axis
    Vec3 normal = Vec3::UnitZ();  // unit: x_axis x y_axis
    double radius_m = 0.1;
    std::uint32_t plane = 0;  // label for its segments
};

inline Vec2 to_disc(const Disc& disc, const Vec3& point) {
    const Vec3 from_center = point - disc.center;
    return {from_center.dot(disc.x_axis), from_center.dot(disc.y_axis)};
}

struct GraphPoint {
    std::uint32_t triangle = k_no_triangle;  // k_no_triangle: no point
    Vec3 point = Vec3::Zero();               // point on the triangle
};

struct CrossingSearch {
    std::uint32_t triangle = k_no_triangle;  // first triangle found whose cut reaches into the disc
    Vec3 point = Vec3::Zero();               // point on the triangle's cut where the search entered
    std::uint32_t pops = 0;                  // triangles visited
};

// Working memory, reused between calls.
struct TraceScratch {
    struct Node {
        double cost_m = 0.0;  // path so far plus estimate of the rest
        double path_m = 0.0;
        std::uint32_t triangle = 0;
        std::uint32_t order = 0;  // insertion index: breaks ties
        Vec3 point = Vec3::Zero();
    };
    std::vector<Node> open;
    std::vector<std::uint32_t> seen;  // hash set of visited triangles
    std::vector<Vec2> line;
    std::vector<std::uint32_t> line_triangle;
};

inline constexpr std::uint32_t k_max_pops = 128;
inline constexpr std::uint32_t k_max_starts = 16;
inline constexpr std::uint32_t k_max_steps = 512;
inline constexpr double k_straight_m = 2.5e-4;  // simplification tolerance of a cut

// A* over neighbours, from all `starts` at once, for a triangle whose cut reaches into the disc.
// Path lengths are measured over the closest points of the edges crossed since the node's start.
// The estimate of the rest is twice the distance from the triangle to the plane. Gives up after
// k_max_pops visits in total, or if every open node lies more than k_prune_m (disc_cut.hpp) outside
// the disc's radius. Preconditions: at most k_max_starts starts; each start's triangle belongs to
// the graph or is k_no_triangle.
CrossingSearch find_crossing(const SurfaceGraph& graph, const Disc& disc,
                             std::span<const GraphPoint> starts, TraceScratch& scratch);

// Starts at a triangle that the disc cuts and walks along the cut in both directions, until the cut
// leaves the disc, ends or closes. Appends its pieces within the disc to `segments`, simplified
// within k_straight_m. Returns the number of triangles walked. A corner on the plane counts as on
// the normal's side, so that every cut triangle has two cut edges.
std::uint32_t walk_crossing(const SurfaceGraph& graph, const Disc& disc, std::uint32_t triangle,
                            TraceScratch& scratch, std::vector<DiscSegment>& segments);

// Appends the segment if part of it lies within `radius_m` of the disc's centre. A very long
// segment is shortened to its part near the centre.
void add_segment(const DiscSegment& segment, double radius_m, std::vector<DiscSegment>& segments);

// add_segment without the test, for a segment that passed a float test: rounding might reject it.
void add_near_part(const DiscSegment& segment, double radius_m, std::vector<DiscSegment>& segments);

}  // namespace handhold
