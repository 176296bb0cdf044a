// Queries of the C interface against shapes and heads (handhold/level.h).
#include <array>
#include <span>

#include "systems/host/host_world.hpp"
#include "systems/physics/place_colliders.hpp"

namespace handhold {
namespace {

constexpr double k_farthest_query_m = 1e4;

// Checks that queries are possible, and moves colliders to the present poses of bodies and heads.
hh_world& queried_world(hh_world* world) {
    world_of(static_cast<const hh_world*>(world));
    require(!world->surfaces.is_asking(), HH_ERROR_STATE,
            "the world is asking your surface query: its own shapes cannot be queried then");
    require_idle(*world);
    if (!world->has_placed_colliders) {
        world->caches.collision.update_shapes();
        const World& w = world->world;
        place_colliders({.persistent_id = w.persistent_id,
                         .collider = w.collider,
                         .filter = w.filter,
                         .body = w.body,
                         .body_pose = w.body_pose,
                         .body_start = w.body_start,
                         .body_velocity = w.body_velocity,
                         .origin = w.player_origin,
                         .player_start = w.player_start,
                         .head = w.head_tracking,
                         .last_valid = w.last_valid,
                         .collision = world->caches.collision,
                         .frame = world->caches.graph},
                        world->tuning.head);
        world->has_placed_colliders = true;
    }
    return *world;
}

// The persistent ids that a query leaves out: that of `player`, or none for a null id.
class Skipped {
  public:
    Skipped(const hh_world& host, hh_player player) {
        if (player.generation != 0) {
            id_ = host.world.persistent_id.at(player_of(host, player)).value;
            count_ = 1;
        }
    }
    std::span<const std::uint64_t> ids() const { return {&id_, count_}; }

  private:
    std::uint64_t id_ = 0;
    std::size_t count_ = 0;
};

Vec3 checked_point(const hh_vec3& point) {
    return checked(point, world_limits::k_max_coordinate_m, "a point beyond 1e9 m, or NaN");
}

template <typename Found>
hh_hit hit_of(const hh_world& host, const Found& found) {
    hh_hit hit{};
    const Entity entity = find_by_id(host.world, {found.id});
    if (host.world.body.contains(entity)) {
        hit.body = id_of<hh_body>(entity);
    } else {
        hit.player = id_of<hh_player>(entity);
    }
    hit.point = to_c(found.point_ws);
    hit.normal = to_c(found.normal_ws);
    hit.distance_m = found.distance_m;
    return hit;
}

// Runs a query that finds at most one surface.
template <typename Query>
hh_result find_one(hh_world* world, hh_player skip, hh_hit* hit, const Query& query) {
    return call([&] {
        hh_world& host = queried_world(world);
        require(hit != nullptr, HH_ERROR_NULL, "the output is null");
        const Skipped skipped(host, skip);
        const auto found = query(host.caches.collision, skipped.ids());
        *hit = found ? hit_of(host, *found) : hh_hit{};
    });
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_world_cast_ray(hh_world* world, hh_vec3 from, hh_vec3 to, hh_player skip,
                            hh_hit* hit) {
    return find_one(world, skip, hit, [&](const CollisionWorld& collision, auto ids) {
        return collision.cast_ray(checked_point(from), checked_point(to), ids);
    });
}

hh_result hh_world_cast_sphere(hh_world* world, double radius_m, hh_vec3 from, hh_vec3 to,
                               hh_player skip, hh_hit* hit) {
    return find_one(world, skip, hit, [&](const CollisionWorld& collision, auto ids) {
        checked(radius_m, 1e-6, k_farthest_query_m, "a radius must lie in [1e-6, 1e4] m");
        return collision.cast_sphere(radius_m, checked_point(from), checked_point(to), ids);
    });
}

hh_result hh_world_closest_point(hh_world* world, hh_vec3 point, double max_distance_m,
                                 hh_player skip, hh_hit* hit) {
    return find_one(world, skip, hit, [&](const CollisionWorld& collision, auto ids) {
        checked(max_distance_m, 0.0, k_farthest_query_m, "a distance must lie in [0, 1e4] m");
        return collision.closest_point(checked_point(point), max_distance_m, ids);
    });
}

hh_result hh_world_overlap_sphere(hh_world* world, hh_vec3 center, double radius_m, hh_player skip,
                                  hh_hit* hits, size_t capacity, size_t* count) {
    return call([&] {
        hh_world& host = queried_world(world);
        const Vec3 center_ws = checked_point(center);
        checked(radius_m, 0.0, k_farthest_query_m, "a radius must lie in [0, 1e4] m");
        const Skipped skipped(host, skip);
        const Vec3 reach = Vec3::Constant(radius_m);
        const std::span<const std::uint64_t> near =
            host.caches.collision.find_near(center_ws - reach, center_ws + reach);
        host.near_ids.assign(near.begin(), near.end());  // the next query overwrites `near`
        host.hits.clear();
        for (const std::uint64_t id : host.near_ids) {
            if (!skipped.ids().empty() && skipped.ids().front() == id) {
                continue;
            }
            const auto found = host.caches.collision.closest_point_on(id, center_ws);
            if (found && found->distance_m <= radius_m) {
                host.hits.push_back(hit_of(host, *found));
            }
        }
        write_list(host.hits.size(), hits, capacity, count,
                   [&](std::size_t i) { return host.hits[i]; });
    });
}
