#pragma once

#include <optional>

#include "engine/collision/closest_point.hpp"
#include "engine/collision/shape_library.hpp"

// Rays and points against one shape in the shape's own frame, in closed form.
namespace handhold {

struct LocalRayHit {
    double fraction = 0.0;        // of the way from `from` to `to`, in [0, 1]
    Vec3 normal = Vec3::UnitY();  // unit, of the surface, on either side
};
// First point of the surface on the way; from inside, the point where the ray leaves. Of a compound
// the surface of the whole: what lies inside of another part is none. Not for meshes.
// Closed forms, because Bullet sees no surface from inside, and its casts on round shapes stop 1.3
// mm off (measured: btSubsimplexConvexCast).
std::optional<LocalRayHit> cast_ray_on_shape(const Shape& shape, const Vec3& from, const Vec3& to);
struct LocalSurfacePoint {
    Vec3 point = Vec3::Zero();    // on the surface, also for a query point inside
    Vec3 normal = Vec3::UnitY();  // unit: towards the query point, or outward where that is inside
                                  // or on the surface
    double distance_m = 0.0;      // 0 inside
};
// Inside of a compound whose parts overlap, the nearest point of one part's surface that is inside
// of no other; there may be a nearer one along the seam. Not for meshes.
LocalSurfacePoint closest_on_shape(const Shape& shape, const Vec3& point);
// A triangle has no inside; for a point on it the normal is the triangle's own.
LocalSurfacePoint closest_on_triangle_surface(const Corners& corners, const Vec3& point);

}  // namespace handhold
