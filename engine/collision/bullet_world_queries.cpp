// Ray, sphere and point queries against all colliders. They only read the world, and each thread
// has its own scratch memory.
#include <algorithm>
#include <limits>
#include <vector>

#include "engine/collision/bullet_sweep.hpp"
#include "engine/collision/bullet_world.hpp"
#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

// Scratch memory per thread, not per call: queries allocate nothing after a thread's first ones.
struct QueryScratch {
    BroadphaseScratch near;
    std::vector<std::uint64_t> ids;      // scratch of find_near
    ConvexPart sphere{Shape{}, Pose{}};  // scratch of cast_sphere
    TriangleShape triangle;
};

QueryScratch& query_scratch() {
    thread_local QueryScratch scratch;
    return scratch;
}

bool contains(std::span<const std::uint64_t> ids, std::uint64_t id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
}

// True only if a sphere that moves from the origin by `move` misses the triangle. Tests two
// separating planes: one parallel to the triangle, and one perpendicular to the shortest line from
// the path to the triangle's centre.
bool sphere_misses(const Corners& corners, const Vec3& move, double radius_m) {
    const auto is_between = [&](const Vec3& normal) {
        const double a = normal.dot(corners[0]);
        const double b = normal.dot(corners[1]);
        const double c = normal.dot(corners[2]);
        const double along = normal.dot(move);
        const double gap_above = std::min({a, b, c}) - std::max(0.0, along);
        const double gap_below = std::min(0.0, along) - std::max({a, b, c});
        const double gap = std::max(gap_above, gap_below);
        return gap > 0.0 && gap * gap > radius_m * radius_m * normal.squaredNorm();
    };
    if (is_between((corners[1] - corners[0]).cross(corners[2] - corners[0]))) {
        return true;
    }
    const Vec3 centre = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    const double length2 = move.squaredNorm();
    const double nearest = length2 > 0.0 ? std::clamp(centre.dot(move) / length2, 0.0, 1.0) : 0.0;
    return is_between(centre - nearest * move);
}

// Calls visit(proxy) for bodies whose bounds overlap the box, ascending by id.
template <typename Visit>
void visit_bodies(const Broadphase& broadphase, const Bounds& box,
                  std::span<const std::uint64_t> skip, const Visit& visit) {
    for (const std::size_t index : broadphase.find(box, query_scratch().near)) {
        const ColliderProxy& proxy = broadphase.bodies()[index].proxy;
        if (!contains(skip, proxy.id)) {
            visit(proxy);
        }
    }
}

}  // namespace

std::span<const std::uint64_t> CollisionWorld::find_near(const Vec3& low_ws,
                                                         const Vec3& high_ws) const {
    std::vector<std::uint64_t>& ids = query_scratch().ids;
    ids.clear();
    visit_bodies(impl_->broadphase, {low_ws, high_ws}, {},
                 [&ids](const ColliderProxy& proxy) { ids.push_back(proxy.id); });
    return ids;
}

std::uint64_t CollisionWorld::hash_near(const Vec3& low_ws, const Vec3& high_ws,
                                        std::span<const std::uint64_t> skip) const {
    HashStream hash;
    const Bounds box{low_ws, high_ws};
    visit_bodies(impl_->broadphase, box, skip, [&](const ColliderProxy& proxy) {
        // Tests the bounds at the end pose, because the broadphase's bounds also contain the motion
        // from from_ws, on which no query depends.
        if (!overlaps(box,
                      swept_bounds(impl_->extents[proxy.shape.index], proxy.to_ws, proxy.to_ws))) {
            return;
        }
        hash.add(proxy.id);
        hash.add(std::uint64_t{proxy.shape.index});
        for (Eigen::Index i = 0; i < 3; ++i) {
            hash.add(proxy.to_ws.position[i]);
        }
        for (Eigen::Index i = 0; i < 4; ++i) {
            hash.add(proxy.to_ws.rotation.coeffs()[i]);
        }
    });
    return hash.value();
}

std::optional<RayHit> CollisionWorld::cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                               std::span<const std::uint64_t> skip) const {
    const Vec3 displacement_ws = to_ws - from_ws;
    double fraction = std::numeric_limits<double>::infinity();
    std::optional<RayHit> best;
    const auto cast = [&](const ColliderProxy& proxy) {
        const std::optional<ScaledTriangles>& triangles = impl_->cache[proxy.shape.index].triangles;
        const Vec3 from = inverse_transform_point(proxy.to_ws, from_ws);
        const Vec3 to = inverse_transform_point(proxy.to_ws, to_ws);
        const auto offer = [&](const std::optional<LocalRayHit>& hit) {
            if (hit && hit->fraction < fraction) {
                fraction = hit->fraction;
                const double side = hit->normal.dot(to - from) <= 0.0 ? 1.0 : -1.0;
                best = RayHit{proxy.id, from_ws + fraction * displacement_ws,
                              proxy.to_ws.rotation * (side * hit->normal),
                              fraction * displacement_ws.norm()};
            }
        };
        offer(triangles ? triangles->cast_ray(from, to)
                        : cast_ray_on_shape(impl_->shapes.at(proxy.shape), from, to));
    };
    visit_bodies(impl_->broadphase, bounds_of(from_ws, to_ws), skip, cast);
    return best;
}

std::optional<RayHit> CollisionWorld::cast_sphere(double radius_m, const Vec3& from_ws,
                                                  const Vec3& to_ws,
                                                  std::span<const std::uint64_t> skip) const {
    HH_CHECK(radius_m > 0.0, "radius_m must be positive", radius_m);
    QueryScratch& scratch = query_scratch();
    scratch.sphere.set_sphere_radius(radius_m);
    const double reach_m = radius_m + k_rounding_m;
    double fraction = 1.0;
    std::optional<RayHit> best;
    const auto cast = [&](const ColliderProxy& proxy) {
        const CollisionShape& shape = impl_->cache[proxy.shape.index];
        // Near space here: the collider's axes, with the origin at the sphere's start.
        const Vec3 from = inverse_transform_point(proxy.to_ws, from_ws);
        const Vec3 along = inverse_transform_point(proxy.to_ws, to_ws) - from;
        const RelativeMotion motion({}, {along, Quat::Identity()});
        const auto offer = [&](const Convex& b) {
            const auto hit = time_of_impact(scratch.sphere, motion, b, {.fraction = fraction});
            if (hit && (!best || hit->fraction < fraction)) {
                fraction = hit->fraction;
                best = RayHit{proxy.id, transform_point(proxy.to_ws, from + hit->point_b_ns),
                              proxy.to_ws.rotation * hit->normal, fraction * along.norm()};
            }
        };
        for (const ConvexPart& part : shape.parts) {
            offer(part.at({-from, Quat::Identity()}));
        }
        if (!shape.triangles) {
            return;
        }
        shape.triangles->visit_path(from, along, reach_m, fraction, [&](const Corners& corners) {
            const Corners near{corners[0] - from, corners[1] - from, corners[2] - from};
            if (sphere_misses(near, fraction * along, reach_m)) {
                return;
            }
            if (const Vec3 area = area_vector(near); !area.isZero(0.0)) {
                offer(scratch.triangle.place(near, area / area.norm()));
            }
        });
    };
    visit_bodies(impl_->broadphase, bounds_of(from_ws, to_ws).grown(reach_m), skip, cast);
    return best;
}

std::optional<SurfacePoint> CollisionWorld::closest_point(
    const Vec3& point_ws, double max_distance_m, std::span<const std::uint64_t> skip) const {
    double reach_m = max_distance_m;
    std::optional<SurfacePoint> best;
    const auto find = [&](const ColliderProxy& proxy) {
        const std::optional<ScaledTriangles>& triangles = impl_->cache[proxy.shape.index].triangles;
        const Vec3 point = inverse_transform_point(proxy.to_ws, point_ws);
        const std::optional<LocalSurfacePoint> near =
            triangles ? triangles->closest_point(point, reach_m)
                      : closest_on_shape(impl_->shapes.at(proxy.shape), point);
        if (near && (best ? near->distance_m < reach_m : near->distance_m <= reach_m)) {
            reach_m = near->distance_m;
            best = SurfacePoint{proxy.id, transform_point(proxy.to_ws, near->point),
                                proxy.to_ws.rotation * near->normal, near->distance_m};
        }
    };
    visit_bodies(impl_->broadphase, bounds_of(point_ws, point_ws).grown(max_distance_m), skip,
                 find);
    return best;
}

std::optional<SurfacePoint> CollisionWorld::closest_point_on(std::uint64_t id,
                                                             const Vec3& point_ws) const {
    const std::span<const BroadphaseBody> bodies = impl_->broadphase.bodies();
    const std::size_t index = impl_->broadphase.find_index(id);
    if (index == bodies.size() || !is_valid(bodies[index].proxy.to_ws)) {
        return std::nullopt;
    }
    const ColliderProxy& proxy = bodies[index].proxy;
    const std::optional<ScaledTriangles>& triangles = impl_->cache[proxy.shape.index].triangles;
    const Vec3 point = inverse_transform_point(proxy.to_ws, point_ws);
    constexpr double k_anywhere_m = 1e9;
    const std::optional<LocalSurfacePoint> near =
        triangles ? triangles->closest_point(point, k_anywhere_m)
                  : closest_on_shape(impl_->shapes.at(proxy.shape), point);
    if (!near) {
        return std::nullopt;
    }
    return SurfacePoint{id, transform_point(proxy.to_ws, near->point),
                        proxy.to_ws.rotation * near->normal, near->distance_m};
}

}  // namespace handhold
