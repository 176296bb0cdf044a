#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "engine/geometry/disc_trace.hpp"

// Where a disc's plane cuts triangles of a surface graph: the steps of find_crossing and
// walk_crossing.
namespace handhold {

// Edges outside the disc's radius by more than this are out of reach.
inline constexpr double k_prune_m = 0.03;

// Points at which a disc's plane cuts two edges of a triangle.
struct TriangleCut {
    std::array<std::uint32_t, 2> edge = {};  // corners i and i + 1
    std::array<Vec3, 2> point;               // points in the surface's frame
};

// Signed distance of `point` from the disc's plane, positive on the normal's side.
double height_over(const Disc& disc, const Vec3& point);

// Signed distances of a triangle's corners from the disc's plane.
std::array<double, 3> corner_heights(const SurfaceGraph& graph, const Disc& disc,
                                     std::uint32_t triangle);

// None if all corners lie on one side; a corner on the plane counts as on the normal's side.
// Neighbours get bitwise the same point on their common edge.
std::optional<TriangleCut> cut_triangle(const SurfaceGraph& graph, const Disc& disc,
                                        std::uint32_t triangle);

// Distance from disc space's origin to the segment.
double distance_to_origin(const Vec2& a, const Vec2& b);

// True if the cut comes within the disc's radius.
bool reaches_disc(const Disc& disc, const TriangleCut& cut);

// True if the edge from corner `edge` comes within k_prune_m of the disc's radius.
bool is_edge_in_reach(const SurfaceGraph& graph, const Disc& disc, std::uint32_t triangle,
                      std::uint32_t edge);

}  // namespace handhold
