// Contact normals at internal edges are found with the normal cone of the surface. If the surface
// next to a point rises above the plane through this point with a given normal, no body can touch
// the point along this normal. No adjacency is needed, so cracks between parts, T-junctions and
// mixed winding need no preprocessing.
#include "engine/collision/mesh_contact.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr double k_parts_meet_m = 1e-5;  // triangles this near to a point count as touching it
constexpr double k_rise_sine = 1e-6;     // tolerance of the normal cone: 6e-5 degrees
constexpr double k_face_sine = 1e-6;     // normals within this of a face normal are snapped to it

bool touches(const NearTriangle& triangle, const Vec3& point) {
    return (closest_on_triangle(point, triangle.corners_ns) - point).norm() <= k_parts_meet_m;
}

bool rises_above(const NearTriangle& triangle, const Vec3& point, const Vec3& normal) {
    return std::any_of(triangle.corners_ns.begin(), triangle.corners_ns.end(), [&](const Vec3& c) {
        const Vec3 leg = c - point;
        return leg.dot(normal) > k_parts_meet_m * 1e-3 + k_rise_sine * leg.norm();
    });
}

// The triangle's normal on the side of `centre_from`.
Vec3 outward_normal(const NearTriangle& triangle, const Vec3& centre_from) {
    return (centre_from - triangle.corners_ns[0]).dot(triangle.normal) >= 0.0
               ? triangle.normal
               : Vec3(-triangle.normal);
}

// True if the segment's ends lie on different sides of the triangle's plane.
bool changes_side(const NearTriangle& triangle, const Vec3& from, const Vec3& to) {
    const double before = (from - triangle.corners_ns[0]).dot(triangle.normal);
    const double after = (to - triangle.corners_ns[0]).dot(triangle.normal);
    return (before >= 0.0) != (after >= 0.0);
}

bool crosses(const NearTriangle& triangle, const Vec3& from, const Vec3& to) {
    if (!changes_side(triangle, from, to)) {
        return false;
    }
    const double before = (from - triangle.corners_ns[0]).dot(triangle.normal);
    const double after = (to - triangle.corners_ns[0]).dot(triangle.normal);
    const Vec3 through = from + before / (before - after) * (to - from);
    return (closest_on_triangle(through, triangle.corners_ns) - through).norm() <= k_parts_meet_m;
}

// Fast rejection: true if a's bounding sphere plus margin misses the triangle.
bool is_far(const MeshContactIo& io, const NearTriangle& triangle) {
    const double reach_m = io.core_reach_m + io.a.radius_m + io.margin_m;
    const Vec3 centre = io.a.centre_ns();
    if (!overlaps(triangle.box_ns, bounds_of(centre, centre).grown(reach_m))) {
        return true;
    }
    if (std::abs((centre - triangle.corners_ns[0]).dot(triangle.normal)) > reach_m) {
        return true;
    }
    return (closest_on_triangle(centre, triangle.corners_ns) - centre).norm() > reach_m;
}

void add_triangle_contacts(const MeshContactIo& io, const NearTriangle& triangle) {
    const Convex b = io.triangle.place(triangle.corners_ns, triangle.normal);
    CoreSeparation separation = separate(io.a, b);
    if (separation.separation_m - io.a.radius_m >= io.margin_m) {
        return;
    }
    const double cosine = separation.normal.dot(triangle.normal);
    const bool is_face = separation.normal.cross(triangle.normal).norm() < k_face_sine;
    if (is_face) {
        separation.normal = cosine > 0.0 ? triangle.normal : Vec3(-triangle.normal);
    } else if (!in_normal_cone(io.triangles, separation.point_b_ns, separation.normal)) {
        // At an internal edge the neighbouring triangle is nearer and produces the contact, so this
        // triangle produces none. But if a's core (the shape without its radius) overlaps this
        // triangle, there may be no such neighbour: then this triangle's face produces the
        // contacts.
        if (separation.overlap) {
            add_face_manifold(io.a, b, outward_normal(triangle, io.centre_from_ns), io.margin_m,
                              io.scratch, io.contacts);
        }
        return;
    }
    add_manifold(io.a, b, separation, io.margin_m, io.scratch, io.contacts);
}

}  // namespace

bool in_normal_cone(const NearTriangles& triangles, const Vec3& point, const Vec3& normal) {
    return !triangles.any_at(point, k_parts_meet_m, [&](const NearTriangle& triangle) {
        return touches(triangle, point) && rises_above(triangle, point, normal);
    });
}

void add_mesh_contacts(const MeshContactIo& io) {
    const Vec3& from = io.centre_from_ns;
    const Vec3 to = io.a.centre_ns();
    // A change of side is not enough: a body that slides over the edge of a step changes sides of
    // the step's front plane without touching it. A centre is on the wrong side only if it crossed
    // the surface itself.
    const bool crossed =
        std::any_of(io.triangles.all().begin(), io.triangles.all().end(),
                    [&](const NearTriangle& triangle) { return crosses(triangle, from, to); });
    for (const NearTriangle& triangle : io.triangles.all()) {
        if (crossed && changes_side(triangle, from, to)) {
            const Convex b = io.triangle.place(triangle.corners_ns, triangle.normal);
            add_face_manifold(io.a, b, outward_normal(triangle, from), io.margin_m, io.scratch,
                              io.contacts);
        } else if (!is_far(io, triangle)) {
            add_triangle_contacts(io, triangle);
        }
    }
}

}  // namespace handhold
