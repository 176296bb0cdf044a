#include "systems/host/host_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "systems/host/host_call.hpp"

namespace handhold {
namespace {

// The host's handles of the first 32 bodies with these ids. Leaves out players' heads, for which
// the host has no bodies.
struct SkippedBodies {
    SkippedBodies(const World& world, std::span<const std::uint64_t> ids) {
        for (const std::uint64_t id : ids) {
            const Entity entity = find_by_id(world, {id});
            if (count < bodies.size() && world.body.contains(entity)) {
                bodies[count++] = id_of<hh_body>(entity);
            }
        }
    }
    std::array<hh_body, 32> bodies{};
    std::size_t count = 0;
};

}  // namespace

std::optional<HostSurfaces::Checked> HostSurfaces::check(const hh_surface_hit& hit) const {
    const Entity body = entity_of(hit.body);
    const Vec3 point_ws = from_c(hit.point);
    const Vec3 normal_ws = from_c(hit.normal);
    const double length = normal_ws.norm();
    const bool is_near = point_ws.cwiseAbs().maxCoeff() <= world_limits::k_max_coordinate_m;
    const bool has_normal = length > 1e-12 && length < 1e12;
    if (!world_->body.contains(body) || !point_ws.allFinite() || !is_near || !has_normal ||
        !std::isfinite(hit.distance_m)) {
        ++refused_;
        return std::nullopt;
    }
    return Checked{world_->persistent_id.at(body).value, point_ws, normal_ws / length,
                   std::max(0.0, hit.distance_m)};
}

std::optional<RayHit> HostSurfaces::cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                             std::span<const std::uint64_t> skip) const {
    if (query_.cast_ray == nullptr) {
        return std::nullopt;
    }
    const SkippedBodies skipped(*world_, skip);
    hh_surface_hit hit{};
    if (!answer([&] {
            return query_.cast_ray(query_.context, to_c(from_ws), to_c(to_ws),
                                   skipped.bodies.data(), skipped.count, &hit);
        })) {
        return std::nullopt;
    }
    const auto found = check(hit);
    if (!found) {
        return std::nullopt;
    }
    const bool faces_away = found->normal_ws.dot(to_ws - from_ws) > 0.0;
    return RayHit{found->id, found->point_ws, faces_away ? -found->normal_ws : found->normal_ws,
                  (found->point_ws - from_ws).norm()};
}

std::optional<RayHit> HostSurfaces::cast_sphere(double radius_m, const Vec3& from_ws,
                                                const Vec3& to_ws,
                                                std::span<const std::uint64_t> skip) const {
    if (query_.cast_sphere == nullptr) {
        return std::nullopt;
    }
    const SkippedBodies skipped(*world_, skip);
    hh_surface_hit hit{};
    if (!answer([&] {
            return query_.cast_sphere(query_.context, radius_m, to_c(from_ws), to_c(to_ws),
                                      skipped.bodies.data(), skipped.count, &hit);
        })) {
        return std::nullopt;
    }
    const auto found = check(hit);
    if (!found) {
        return std::nullopt;
    }
    const bool faces_away = found->normal_ws.dot(to_ws - from_ws) > 0.0;
    return RayHit{found->id, found->point_ws, faces_away ? -found->normal_ws : found->normal_ws,
                  std::min(found->distance_m, (to_ws - from_ws).norm())};
}

std::optional<SurfacePoint> HostSurfaces::surface_point(const hh_surface_hit& hit,
                                                        const Vec3& point_ws,
                                                        double max_distance_m) const {
    const auto found = check(hit);
    if (!found) {
        return std::nullopt;
    }
    constexpr double k_on_surface_m = 1e-9;
    const Vec3 offset = point_ws - found->point_ws;
    const bool is_outside = found->distance_m > 0.0 && offset.norm() > k_on_surface_m;
    const double distance_m = is_outside ? offset.norm() : 0.0;
    if (distance_m > max_distance_m) {
        return std::nullopt;
    }
    return SurfacePoint{found->id, found->point_ws,
                        is_outside ? Vec3(offset / distance_m) : found->normal_ws, distance_m};
}

std::optional<SurfacePoint> HostSurfaces::closest_point(const Vec3& point_ws, double max_distance_m,
                                                        std::span<const std::uint64_t> skip) const {
    if (query_.closest_point == nullptr) {
        return std::nullopt;
    }
    const SkippedBodies skipped(*world_, skip);
    hh_surface_hit hit{};
    const bool is_found = answer([&] {
        return query_.closest_point(query_.context, to_c(point_ws), max_distance_m,
                                    skipped.bodies.data(), skipped.count, &hit);
    });
    return is_found ? surface_point(hit, point_ws, max_distance_m) : std::nullopt;
}

std::optional<SurfacePoint> HostSurfaces::closest_point_on(std::uint64_t id,
                                                           const Vec3& point_ws) const {
    const Entity body = find_by_id(*world_, {id});
    if (query_.closest_point_on == nullptr || !world_->body.contains(body)) {
        return std::nullopt;
    }
    hh_surface_hit hit{};
    const hh_body wanted = id_of<hh_body>(body);
    if (!answer([&] {
            return query_.closest_point_on(query_.context, wanted, to_c(point_ws), &hit);
        })) {
        return std::nullopt;
    }
    hit.body = wanted;
    return surface_point(hit, point_ws, std::numeric_limits<double>::infinity());
}

std::uint64_t HostSurfaces::take_refused() const {
    const std::uint64_t refused = refused_;
    refused_ = 0;
    return refused;
}

}  // namespace handhold
