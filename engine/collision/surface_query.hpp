#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "engine/math/math.hpp"

// Queries against surfaces that belong to a CollisionWorld or to a host's engine.
namespace handhold {

struct RayHit {
    std::uint64_t id = 0;
    Vec3 point_ws = Vec3::Zero();
    // Unit vector, on the side that the ray came from, whatever the triangle's winding.
    Vec3 normal_ws = Vec3::UnitY();
    double distance_m = 0.0;  // distance from the ray's start
};

struct SurfacePoint {
    std::uint64_t id = 0;
    Vec3 point_ws = Vec3::Zero();
    // Unit vector from the surface point towards the query point. Points outward if the two
    // coincide or if the query point is inside.
    Vec3 normal_ws = Vec3::UnitY();
    double distance_m = 0.0;  // 0 inside a solid; point_ws is on the surface there too
};

// A reference to an object with the queries below; CollisionWorld documents them. The object must
// outlive the reference, and may lack hash_near. If the object's member k_any_thread is true,
// several threads may query it at the same time. A reference without an object finds nothing.
class SurfaceQuery {
  public:
    using Skip = std::span<const std::uint64_t>;

    SurfaceQuery() = default;
    // Implicit conversion, like that of a container to a view.
    template <typename Surfaces>
    requires(!std::is_same_v<Surfaces, SurfaceQuery>)
        // NOLINTNEXTLINE(google-explicit-constructor)
        SurfaceQuery(const Surfaces& surfaces)
        : surfaces_(&surfaces), functions_(&k_functions_of<Surfaces>) {}

    // True if several threads may query at the same time.
    bool any_thread() const { return surfaces_ == nullptr || functions_->any_thread; }

    // False if there is no object, so that all queries find nothing.
    explicit operator bool() const { return surfaces_ != nullptr; }

    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws, Skip skip = {}) const {
        return surfaces_ != nullptr ? functions_->cast_ray(surfaces_, from_ws, to_ws, skip)
                                    : std::nullopt;
    }
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      Skip skip = {}) const {
        return surfaces_ != nullptr
                   ? functions_->cast_sphere(surfaces_, radius_m, from_ws, to_ws, skip)
                   : std::nullopt;
    }
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              Skip skip = {}) const {
        return surfaces_ != nullptr
                   ? functions_->closest_point(surfaces_, point_ws, max_distance_m, skip)
                   : std::nullopt;
    }
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const {
        return surfaces_ != nullptr ? functions_->closest_point_on(surfaces_, id, point_ws)
                                    : std::nullopt;
    }
    // nullopt: unknown, because the object does not have this query.
    std::optional<std::uint64_t> hash_near(const Vec3& low_ws, const Vec3& high_ws,
                                           Skip skip = {}) const {
        return surfaces_ != nullptr ? functions_->hash_near(surfaces_, low_ws, high_ws, skip)
                                    : std::nullopt;
    }

  private:
    struct Functions {
        std::optional<RayHit> (*cast_ray)(const void*, const Vec3&, const Vec3&, Skip);
        std::optional<RayHit> (*cast_sphere)(const void*, double, const Vec3&, const Vec3&, Skip);
        std::optional<SurfacePoint> (*closest_point)(const void*, const Vec3&, double, Skip);
        std::optional<SurfacePoint> (*closest_point_on)(const void*, std::uint64_t, const Vec3&);
        std::optional<std::uint64_t> (*hash_near)(const void*, const Vec3&, const Vec3&, Skip);
        bool any_thread;
    };
    template <typename Surfaces>
    static constexpr bool allows_any_thread() {
        if constexpr (requires { Surfaces::k_any_thread; }) {
            return Surfaces::k_any_thread;
        } else {
            return false;
        }
    }
    template <typename Surfaces>
    static constexpr Functions k_functions_of = {
        [](const void* surfaces, const Vec3& from_ws, const Vec3& to_ws, Skip skip) {
            return static_cast<const Surfaces*>(surfaces)->cast_ray(from_ws, to_ws, skip);
        },
        [](const void* surfaces, double radius_m, const Vec3& from_ws, const Vec3& to_ws,
           Skip skip) {
            return static_cast<const Surfaces*>(surfaces)->cast_sphere(radius_m, from_ws, to_ws,
                                                                       skip);
        },
        [](const void* surfaces, const Vec3& point_ws, double max_distance_m, Skip skip) {
            return static_cast<const Surfaces*>(surfaces)->closest_point(point_ws, max_distance_m,
                                                                         skip);
        },
        [](const void* surfaces, std::uint64_t id, const Vec3& point_ws) {
            return static_cast<const Surfaces*>(surfaces)->closest_point_on(id, point_ws);
        },
        [](const void* surfaces, const Vec3& low_ws, const Vec3& high_ws,
           Skip skip) -> std::optional<std::uint64_t> {
            if constexpr (requires(const Surfaces& s) { s.hash_near(low_ws, high_ws, skip); }) {
                return static_cast<const Surfaces*>(surfaces)->hash_near(low_ws, high_ws, skip);
            } else {
                return std::nullopt;
            }
        },
        allows_any_thread<Surfaces>()};

    const void* surfaces_ = nullptr;
    const Functions* functions_ = nullptr;
};

}  // namespace handhold
