#include "systems/body/shared/body_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/anim/deflect_outward.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

// Radii of the parts, for an eye height of k_scale_eye_m. The cast spheres are larger, so that a
// cast finds the surface again on which a part rests. A cast along the trunk begins in the head and
// is narrower than the head's sphere; a cast along a leg begins in the pelvis and is narrower than
// the trunk.
constexpr double k_trunk_radius_m = 0.09;
constexpr double k_thigh_contact_radius_m = 0.065;
constexpr double k_shin_contact_radius_m = 0.05;
constexpr double k_cast_wider_m = 0.015;
constexpr double k_sole_m = 0.11;  // distance of the sole below the ankle
// In the player's metres: the greatest radius of a cast, because the head's sphere does not depend
// on the eye height, and the margin for motion until the next search.
constexpr double k_widest_cast_m = 0.105;
constexpr double k_ahead_m = 0.15;

// True if this part is searched in this frame. The phase differs between players and parts, which
// spreads the searches over frames.
bool searches_now(double t_s, double dt_s, std::uint64_t player, std::size_t part) {
    constexpr std::uint64_t k_phases = 8;
    const double phase = static_cast<double>(player % k_phases) / static_cast<double>(k_phases) +
                         static_cast<double>(part) / static_cast<double>(k_body_searches);
    return std::floor(t_s * k_body_searches_per_s + phase) !=
           std::floor((t_s - dt_s) * k_body_searches_per_s + phase);
}

// The line along a part, relative to the chest.
struct PartLine {
    Vec3 from_m;
    Vec3 to_m;
    double radius_m;
    double beyond_m;  // how far the part extends beyond to_m
};
PartLine line_of(const BodySurroundings& around, std::size_t part) {
    const double scale = around.floor.scale;
    const auto from_chest = [&](const Vec3& point_ws) {
        return Vec3(around.origin_ws.rotation.conjugate() *
                    (point_ws - around.shown.chest_ws.position));
    };
    if (part == k_free_body) {
        return {around.head_ps - around.chest_ps, scale * k_free_body_m * around.free_ps,
                scale * k_trunk_radius_m, 0.0};
    }
    const Vec3 pelvis_m = from_chest(around.shown.pelvis_ws.position);
    if (part == 0) {
        return {around.head_ps - around.chest_ps, pelvis_m, scale * k_trunk_radius_m, 0.0};
    }
    const SpinePose::Leg& leg = around.shown.legs[(part - 1) / 2];
    if (spine_links()[k_spine_links + part - 1].kind == SpineLinkKind::thigh) {
        return {pelvis_m, from_chest(leg.shin_ws.position), scale * k_thigh_contact_radius_m, 0.0};
    }
    return {pelvis_m, from_chest(leg.foot_ws.position), scale * k_shin_contact_radius_m,
            scale * k_sole_m};
}

// True if the surface coincides with the tracked floor, above which pose_spine folds the body.
bool is_tracked_floor(const Vec3& normal_ps, double surface_m, const BodySurroundings& around) {
    constexpr double k_level_cosine = 0.9;
    constexpr double k_near_m = 0.15;
    return normal_ps.y() > k_level_cosine &&
           std::abs(surface_m / normal_ps.y() + around.floor.chest_m) <
               around.origin_scale * k_near_m;
}

// Casts a sphere along a part unless the last result is still valid.
void search_part(const BodySurroundings& around, const Vec3& from_ws, const Vec3& to_ws,
                 double radius_m, BodySearch& search) {
    const std::array<std::uint64_t, 1> skip = {around.own_id};
    const double moved_m = around.origin_scale * k_part_moved_m;
    const auto hash_near = [&]() -> std::optional<std::uint64_t> {
        const Vec3 reach_m = Vec3::Constant(radius_m + moved_m);
        const auto near =
            around.surfaces.hash_near(search.from_ws.cwiseMin(search.to_ws) - reach_m,
                                      search.from_ws.cwiseMax(search.to_ws) + reach_m, skip);
        if (!near) {
            return std::nullopt;
        }
        HashStream hash;
        hash.add(*near);
        hash.add(radius_m);
        return hash.value();
    };
    const double moved2 = moved_m * moved_m;
    if (search.known && (from_ws - search.from_ws).squaredNorm() < moved2 &&
        (to_ws - search.to_ws).squaredNorm() < moved2 && hash_near() == search.near) {
        return;
    }
    search.from_ws = from_ws;
    search.to_ws = to_ws;
    const std::optional<std::uint64_t> near = hash_near();
    search.known = near.has_value();
    search.near = near.value_or(0);
    auto hit = around.surfaces.cast_sphere(radius_m, from_ws, to_ws, skip);
    if (hit && !(hit->distance_m > 0.0)) {
        // The cast begins inside a surface, which hides the surfaces farther along.
        hit = around.surfaces.cast_ray(from_ws, to_ws, skip);
    }
    search.hits = hit.has_value();
    if (hit) {
        search.point_ws = hit->point_ws;
        search.normal_ws = hit->normal_ws;
    }
}

BodyContact find_contact(const BodySurroundings& around, std::size_t part, SpineMemory& memory) {
    const PartLine line = line_of(around, part);
    // A cast that begins behind the trunk's surface would hit the surface from behind. The part
    // then uses the trunk's contact.
    const BodyContact& trunk = memory.contacts[0];
    if (part > 0 && part != k_free_body && trunk.touches &&
        trunk.normal_ps.dot(line.from_m) < trunk.surface_m - line.radius_m) {
        return trunk;
    }
    const Vec3 path = line.to_m - line.from_m;
    const double length_m = path.norm();
    if (!(length_m > 1e-3)) {
        return {};
    }
    const Vec3 along = path * (1.0 / length_m);
    const auto in_world = [&](const Vec3& from_chest_m) {
        return transform_point(around.origin_ws, around.chest_ps + from_chest_m);
    };
    BodySearch& search = memory.searches[part];
    const double beyond_m = line.beyond_m + around.origin_scale * k_ahead_m;
    search_part(around, in_world(line.from_m), in_world(line.to_m + beyond_m * along),
                std::min(line.radius_m + around.floor.scale * k_cast_wider_m,
                         around.origin_scale * k_widest_cast_m),
                search);
    if (!search.hits) {
        return {};
    }
    const Vec3 normal_ps = around.origin_ws.rotation.conjugate() * search.normal_ws;
    const double surface_m =
        normal_ps.dot(inverse_transform_point(around.origin_ws, search.point_ws) - around.chest_ps);
    // Height of the pelvis above the floor before the chain is folded.
    const double pelvis_m =
        (around.floor.chest_m + memory.offset_m[k_spine_links - 1].y()) / around.floor.scale;
    if ((part == k_free_body || legs_fold(pelvis_m)) &&
        is_tracked_floor(normal_ps, surface_m, around)) {
        return {};
    }
    const double thickness_m = std::max(line.radius_m, -line.beyond_m * normal_ps.dot(along));
    return {true, normal_ps, surface_m + thickness_m};
}

}  // namespace

void find_body_contacts(const BodySurroundings& around, double t_s, double dt_s,
                        const Vec3& moved_m, SpineMemory& memory) {
    for (std::size_t part = 0; part < k_body_searches; ++part) {
        BodyContact& contact = memory.contacts[part];
        if (searches_now(t_s, dt_s, around.own_id, part)) {
            contact = find_contact(around, part, memory);
        } else {
            contact.surface_m -= contact.normal_ps.dot(moved_m);
        }
    }
}

const BodyContact* contact_of(const SpineMemory& memory, std::size_t link) {
    const BodyContact& contact = memory.contacts[body_part_of(link)];
    return contact.touches ? &contact : nullptr;
}

Vec3 before_surface(const TouchingLink& link, const SpineFrame& above, const BodyContact& contact) {
    constexpr double k_out_mps = 2.0;  // length in the player's metres
    constexpr double k_any_lift = 2.0;
    const double least_m = contact.surface_m - contact.normal_ps.dot(link.base_m);
    const Vec3 outside = deflect_outward(link.towards, above.axes.transpose() * contact.normal_ps,
                                         least_m / link.length_m, k_any_lift);
    const Vec3 turn = outside - link.towards;
    const double size = turn.norm();
    const double most = link.scale * k_out_mps * k_spine_tick_s / link.length_m;
    return size <= most ? outside : (link.towards + turn * (most / size)).normalized();
}

Vec3 touching_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps) {
    constexpr double k_kept = 0.85;  // kept share of the speed per tick: surfaces are rough
    const double before = normal.dot(velocity_mps);
    const Vec3 corrected_mps = velocity_mps + correction_mps;
    const double after = normal.dot(corrected_mps);
    return k_kept *
           (corrected_mps + (std::clamp(after, 0.0, std::max(0.0, before)) - after) * normal);
}

}  // namespace handhold
