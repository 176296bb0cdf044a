#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <handhold/your_physics.h>

#include "components/world.hpp"
#include "engine/collision/surface_query.hpp"

namespace handhold {

// Answers the queries of SurfaceQuery with the host's functions, and checks the host's answers. A
// query whose function is null finds nothing. At most 32 bodies are skipped.
class HostSurfaces {
  public:
    // `world` maps ids to bodies. It must outlive this object.
    explicit HostSurfaces(const World& world) : world_(&world) {}
    void set(const hh_surface_query& query) { query_ = query; }

    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip) const;
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip) const;
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip) const;
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const;

    // True while the host answers a query.
    bool is_asking() const { return is_asking_; }
    // Answers that were ignored since the last call.
    std::uint64_t take_refused() const;

  private:
    struct Checked {
        std::uint64_t id = 0;
        Vec3 point_ws;
        Vec3 normal_ws;  // unit
        double distance_m = 0.0;
    };
    // Returns ask(), during which is_asking() is true.
    template <typename Ask>
    bool answer(const Ask& ask) const {
        struct Asking {  // ends also if the host throws
            explicit Asking(bool& flag) : is_asking(flag) { is_asking = true; }
            ~Asking() { is_asking = false; }
            Asking(const Asking&) = delete;
            Asking& operator=(const Asking&) = delete;
            bool& is_asking;
        };
        const Asking asking(is_asking_);
        return ask();
    }
    std::optional<Checked> check(const hh_surface_hit& hit) const;
    std::optional<SurfacePoint> surface_point(const hh_surface_hit& hit, const Vec3& point_ws,
                                              double max_distance_m) const;

    const World* world_;
    hh_surface_query query_{};
    mutable std::uint64_t refused_ = 0;
    mutable bool is_asking_ = false;
};

}  // namespace handhold
