#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/collision/closest_point.hpp"
#include "engine/collision/shape_library.hpp"

// The narrowphase's view of a convex shape, and the distance of two of them. Pure functions:
// nothing outlives a call. All values of one call share one space ("near space", suffix _ns): b's
// axes about a's place, so that figures are as good far from the origin as at it.
namespace handhold {

enum class CoreKind : std::uint8_t { point, segment, triangle, box };

// A point, segment, triangle or box, grown by a radius: sphere, capsule, triangle of a mesh, box.
struct ConvexCore {
    CoreKind kind = CoreKind::point;
    std::uint8_t vertex_count = 1;
    std::array<Vec3, 8>
        vertices_ns;  // of a box: bit i of the index set means the positive side of axis i
    Vec3 centre_ns = Vec3::Zero();
    Mat3 axes = Mat3::Identity();  // box: columns; segment: the first column; triangle: unit normal
                                   // in the first
    Vec3 half_m = Vec3::Zero();    // box
    double radius_m = 0.0;

    std::span<const Vec3> vertices() const { return {vertices_ns.data(), vertex_count}; }
};

// Of a box, sphere or capsule; not of a mesh.
ConvexCore make_core(const Shape& shape, const Pose& pose_ns);
// `unit_normal`: on either side.
ConvexCore make_triangle_core(const Corners& corners_ns, const Vec3& unit_normal);

// How far two cores are apart, radii left out.
struct CoreSeparation {
    Vec3 normal = Vec3::UnitY();  // unit, from b towards a: along the shortest way between the
                                  // cores, or out of b where they overlap
    double separation_m =
        0.0;  // negative: the least way along which a core must move to be free of the other
    Vec3 point_a_ns =
        Vec3::Zero();  // a pair of points of the cores that are this far apart along the normal
    Vec3 point_b_ns = Vec3::Zero();
    bool overlap = false;
};

// Exact for polytopes: all features are compared, nothing is iterated. nullopt where the cores are
// surely farther apart than `limit_m` (a cheap bound; a farther result may still come out).
std::optional<CoreSeparation> separate_cores(
    const ConvexCore& a, const ConvexCore& b,
    double limit_m = std::numeric_limits<double>::infinity());

// The core's point nearest to a point; the point itself inside of a box.
Vec3 closest_on_core(const Vec3& point, const ConvexCore& core);
// The vertex farthest along a direction.
Vec3 support_vertex(const ConvexCore& core, const Vec3& direction);
// Edges of a core as pairs of indices of vertices.
std::span<const std::array<std::uint8_t, 2>> core_edges(CoreKind kind);

}  // namespace handhold
