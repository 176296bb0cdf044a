#pragma once

#include <optional>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/shape_library.hpp"

// Ray and closest-point queries on one shape, in its own frame, in closed form.
namespace handhold {

struct LocalRayHit {
    double fraction = 0.0;        // fraction of the segment from `from` to `to`, [0, 1]
    Vec3 normal = Vec3::UnitY();  // unit surface normal, of either side
};
// First surface point on the segment; if `from` is inside, the exit point. A compound is the union
// of its parts: surfaces inside another part are skipped. Not for meshes. Bullet's casts are not
// used: they miss surfaces hit from inside, and btSubsimplexConvexCast was measured to be up to 1.3
// mm off on round shapes.
std::optional<LocalRayHit> cast_ray_on_shape(const Shape& shape, const Vec3& from, const Vec3& to);
struct LocalSurfacePoint {
    Vec3 point = Vec3::Zero();  // point on the surface, even if the query point is inside
    // Unit: towards the query point; outward if the query point is inside or on the surface.
    Vec3 normal = Vec3::UnitY();
    double distance_m = 0.0;  // 0 inside
};
// Nearest surface point. If the query point is inside overlapping parts of a compound: the nearest
// surface point of one part that is inside no other part. A nearer point may exist where part
// surfaces intersect. Not for meshes.
LocalSurfacePoint closest_on_shape(const Shape& shape, const Vec3& point);
// If the query point is on the triangle, the normal is the triangle's own.
LocalSurfacePoint closest_on_triangle_surface(const Corners& corners, const Vec3& point);

}  // namespace handhold
