// GJK and EPA run on the cores (shapes without their radii), without margins. Results are exact to
// rounding on boxes and triangles, and a radius can be added exactly. Bullet lacks two parts that
// are added here: a check that its answer is optimal, and a normal for cores whose intersection has
// no volume.
#include "engine/collision/bullet_separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "engine/collision/bullet_box_separation.hpp"

namespace handhold {
namespace {

constexpr double k_face_gain_m = 1e-9;

// Direction of separation for cores whose intersection has no volume (a plane or a line). Along any
// direction perpendicular to both cores the depth is 0; this function always chooses the same.
Vec3 flat_exit_direction(const Convex& a, const Convex& b) {
    if (b.corners_ns != nullptr) {
        const Vec3 normal = b.face_normal(0);
        return (a.centre_ns() - (*b.corners_ns)[0]).dot(normal) >= 0.0 ? normal : Vec3(-normal);
    }
    const auto axis = [](const Convex& convex) -> Vec3 {
        if (convex.faces != nullptr) {
            return Vec3::Zero();
        }
        const auto [from, to] = convex.side_line(Vec3::Zero());
        return to - from;
    };
    const Vec3 axis_a = axis(a);
    const Vec3 axis_b = axis(b);
    const Vec3 across = axis_a.cross(axis_b);
    if (across.norm() > 1e-5 * axis_a.norm() * axis_b.norm()) {
        return across.normalized();
    }
    const Vec3 longer = axis_a.norm() > axis_b.norm() ? axis_a : axis_b;
    return longer.norm() > 0.0 ? Vec3(longer.unitOrthogonal()) : Vec3(Vec3::UnitY());
}

// Replaces the normal by a face normal if the two agree within rounding: a normal computed from two
// nearly coincident points is noise.
void snap_to_faces(const Convex& convex, double side, CoreSeparation& result) {
    if (convex.faces == nullptr) {
        return;
    }
    const Vec3 normal = side * convex.face_normal(convex.facing(side * result.normal));
    const double noise = 1e-6 + 1e-15 / std::max(std::abs(result.separation_m), 1e-13);
    if (normal.dot(result.normal) > 0.0 && normal.cross(result.normal).norm() < noise) {
        result.normal = normal;
    }
}

// Replaces `best` if moving out through a face is shorter. EPA returns a wrong depth and normal if
// its first simplex is flat (two aligned cubes: 0.7 mm across an edge instead of 1 mm through a
// face). `side`: +1 for the faces of b, -1 for those of a, whose normals point the other way.
void compare_faces(const Convex& a, const Convex& b, double side, CoreSeparation& best) {
    const Convex& owner = side > 0.0 ? b : a;
    const int count = owner.faces != nullptr ? owner.faces->m_faces.size() : 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal = side * owner.face_normal(i);
        const Vec3 point_a = a.support(-normal);
        const Vec3 point_b = b.support(normal);
        const double separation = normal.dot(point_a - point_b);
        if (separation > best.separation_m + k_face_gain_m) {
            best = {normal, separation, point_a, point_b, true};
            (side > 0.0 ? best.point_b_ns : best.point_a_ns) =
                side > 0.0 ? Vec3(point_a - separation * normal)
                           : Vec3(point_b + separation * normal);
        }
    }
}

double depth_along(const Convex& a, const Convex& b, const Vec3& normal) {
    return normal.dot(a.support(-normal) - b.support(normal));
}

enum class Query { apart, depth_and_exit };

bool run(Query search, const Convex& a, const Convex& b, const btVector3& guess,
         CoreSeparation& result) {
    btGjkEpaSolver2::sResults found;
    const bool any =
        search == Query::apart
            ? btGjkEpaSolver2::Distance(a.shape, a.pose_ns, b.shape, b.pose_ns, guess, found)
            : btGjkEpaSolver2::Penetration(a.shape, a.pose_ns, b.shape, b.pose_ns, guess, found,
                                           false);
    if (any) {
        // Bullet returns the normal in a's frame.
        result.normal = from_bullet(a.pose_ns.getBasis() * found.normal).normalized();
        result.separation_m = found.distance;
        result.point_a_ns = from_bullet(found.witnesses[0]);
        result.point_b_ns = from_bullet(found.witnesses[1]);
        snap_to_faces(a, -1.0, result);
        snap_to_faces(b, 1.0, result);
    }
    return any;
}

// Start direction for repeating a search that stopped early. Each attempt uses another octant.
btVector3 other_guess(int attempt) {
    return {(attempt & 1) != 0 ? 0.9 : -0.8, (attempt & 2) != 0 ? 0.7 : -1.0,
            (attempt & 4) != 0 ? 1.0 : -0.6};
}

// Runs GJK or EPA until the answer is optimal: the depth along its normal equals its separation.
// Bullet stops early in about 1 of 5000 pairs, with errors up to 30 cm. The search then restarts in
// another direction, and the best answer is kept. False if the cores touch (Query::apart) or if
// their intersection has no volume (Query::depth_and_exit).
bool search_until_optimal(Query search, const Convex& a, const Convex& b, btVector3 guess,
                          CoreSeparation& best) {
    constexpr int k_attempts = 8;
    bool any = false;
    for (int attempt = 0; attempt < k_attempts; ++attempt) {
        CoreSeparation result;
        if (run(search, a, b, guess, result)) {
            const double along_m = depth_along(a, b, result.normal);
            // Rounding error of a normal that is computed from nearly coincident points.
            const double noise_m = 1e-9 + 1e-14 / std::max(std::abs(result.separation_m), 1e-13);
            if (std::abs(along_m - result.separation_m) < noise_m) {
                best = result;
                return true;
            }
            result.separation_m = along_m;
            if (!any || along_m > best.separation_m) {
                best = result;
            }
            any = true;
        } else if (search == Query::apart && !any) {
            return false;
        }
        guess = other_guess(attempt);
    }
    return any;
}

// Distance of a sphere's core from a triangle, in closed form. nullopt if they touch, or nearly:
// the direction is then up to GJK and EPA.
std::optional<CoreSeparation> separate_point(const Convex& a, const Convex& b) {
    constexpr double k_least_m = 1e-7;
    if (b.corners_ns == nullptr || a.shape->getShapeType() != SPHERE_SHAPE_PROXYTYPE) {
        return std::nullopt;
    }
    CoreSeparation result;
    result.point_a_ns = a.centre_ns();
    result.point_b_ns = closest_on_triangle(result.point_a_ns, *b.corners_ns);
    const Vec3 offset = result.point_a_ns - result.point_b_ns;
    result.separation_m = offset.norm();
    if (result.separation_m < k_least_m) {
        return std::nullopt;
    }
    result.normal = offset / result.separation_m;
    snap_to_faces(b, 1.0, result);
    return result;
}

}  // namespace

double gap_along_centres(const Convex& a, const Convex& b) {
    const Vec3 offset = a.centre_ns() - b.centre_ns();
    const double distance = offset.norm();
    return distance > 0.0 ? depth_along(a, b, offset / distance) - a.radius_m - b.radius_m : 0.0;
}

CoreSeparation separate(const Convex& a, const Convex& b) {
    if (are_boxes(a, b)) {
        return *separate_boxes(a, b, std::numeric_limits<double>::infinity());
    }
    if (const auto result = separate_point(a, b)) {
        return *result;
    }
    const Vec3 fallback = flat_exit_direction(a, b);
    // Bullet returns `guess` as the normal if the intersection has no volume.
    const btVector3 guess = -(to_bullet(fallback) * a.pose_ns.getBasis());
    CoreSeparation result;
    if (search_until_optimal(Query::apart, a, b, guess, result) && result.separation_m > 0.0) {
        return result;
    }
    if (!search_until_optimal(Query::depth_and_exit, a, b, guess, result)) {
        result.normal = fallback;
        result.separation_m = depth_along(a, b, fallback);
        result.point_a_ns = result.point_b_ns = a.support(-fallback);
    }
    result.overlap = true;
    compare_faces(a, b, 1.0, result);
    compare_faces(a, b, -1.0, result);
    return result;
}

std::optional<CoreSeparation> separate_within(const Convex& a, const Convex& b, double limit_m) {
    if (are_boxes(a, b)) {
        return separate_boxes(a, b, limit_m);
    }
    if (gap_along_centres(a, b) + a.radius_m + b.radius_m > limit_m) {
        return std::nullopt;
    }
    return separate(a, b);
}

}  // namespace handhold
