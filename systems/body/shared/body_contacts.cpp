#include "systems/body/shared/body_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/anim/deflect_outward.hpp"
#include "systems/body/shared/fold_body.hpp"

namespace handhold {
namespace {

// For an eye height of k_scale_eye_m. The trunk's sphere is smaller than the head's, so that a cast
// that begins in the head does not begin in a wall.
constexpr double k_trunk_radius_m = 0.10;
constexpr double k_thigh_radius_m = 0.07;
constexpr double k_shin_radius_m = 0.05;
constexpr double k_sole_m = 0.11;   // below the ankle
constexpr double k_ahead_m = 0.15;  // margin for motion until the next search

// True if this part is searched in this frame. The phase differs between players and parts.
bool searches_now(double t_s, double dt_s, std::uint64_t player, std::size_t part) {
    constexpr double k_per_s = 15.0;
    constexpr std::uint64_t k_phases = 8;
    const double phase = static_cast<double>(player % k_phases) / static_cast<double>(k_phases) +
                         static_cast<double>(part) / static_cast<double>(k_body_parts);
    return std::floor(t_s * k_per_s + phase) != std::floor((t_s - dt_s) * k_per_s + phase);
}

// The line along a part, relative to the chest.
struct PartLine {
    Vec3 from_m;
    Vec3 to_m;
    double radius_m;
    double beyond_m;  // how far the part extends beyond to_m
};
PartLine line_of(const BodySurroundings& around, const SpineMemory& memory, std::size_t part) {
    const double scale = around.floor.scale;
    const Vec3& pelvis_m = memory.offset_m[k_spine_links - 1];
    if (part == 0) {
        return {around.head_ps - around.chest_ps, pelvis_m, scale * k_trunk_radius_m, 0.0};
    }
    const std::size_t link = k_spine_links + part - 1;
    if (spine_links()[link].kind == SpineLinkKind::thigh) {
        return {pelvis_m, memory.offset_m[link], scale * k_thigh_radius_m, 0.0};
    }
    return {memory.offset_m[link - 1], memory.offset_m[link], scale * k_shin_radius_m,
            scale * k_sole_m};
}

// The contact of the part above; null: none.
const BodyContact* above_part(const SpineMemory& memory, std::size_t part) {
    if (part == 0) {
        return nullptr;
    }
    const bool is_thigh = spine_links()[k_spine_links + part - 1].kind == SpineLinkKind::thigh;
    const BodyContact& above = memory.contacts[is_thigh ? 0 : part - 1];
    return above.touches ? &above : nullptr;
}

// True if the surface coincides with the tracked floor, above which pose_spine folds the body.
bool is_tracked_floor(const Vec3& normal_ps, double surface_m, const TrackedFloor& floor) {
    constexpr double k_level_cosine = 0.9;
    constexpr double k_near_m = 0.15;
    return normal_ps.y() > k_level_cosine &&
           std::abs(surface_m / normal_ps.y() + floor.chest_m) < k_near_m;
}

BodyContact find_contact(const BodySurroundings& around, const SpineMemory& memory,
                         std::size_t part) {
    const PartLine line = line_of(around, memory, part);
    // A cast that begins behind a surface would find its back.
    const BodyContact* const above = above_part(memory, part);
    if (above != nullptr && above->normal_ps.dot(line.from_m) < above->surface_m - line.radius_m) {
        return *above;
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
    const std::array<std::uint64_t, 1> skip = {around.own_id};
    const auto hit = around.surfaces.cast_sphere(
        line.radius_m, in_world(line.from_m),
        in_world(line.to_m + (line.beyond_m + k_ahead_m) * along), skip);
    if (!hit) {
        return {};
    }
    const Vec3 normal_ps = around.origin_ws.rotation.conjugate() * hit->normal_ws;
    const double surface_m =
        normal_ps.dot(inverse_transform_point(around.origin_ws, hit->point_ws) - around.chest_ps);
    const double pelvis_m =  // of the chain before it is folded
        (around.floor.chest_m + memory.offset_m[k_spine_links - 1].y()) / around.floor.scale;
    if (legs_fold(pelvis_m) && is_tracked_floor(normal_ps, surface_m, around.floor)) {
        return {};
    }
    const double thickness_m =
        std::max(line.radius_m, -line.beyond_m * normal_ps.dot(along));
    return {true, normal_ps, surface_m + thickness_m};
}

}  // namespace

void find_body_contacts(const BodySurroundings& around, double t_s, double dt_s,
                        const Vec3& moved_m, SpineMemory& memory) {
    for (std::size_t part = 0; part < k_body_parts; ++part) {
        BodyContact& contact = memory.contacts[part];
        if (searches_now(t_s, dt_s, around.own_id, part)) {
            contact = find_contact(around, memory, part);
        } else {
            contact.surface_m -= contact.normal_ps.dot(moved_m);
        }
    }
}

const BodyContact* contact_of(const SpineMemory& memory, std::size_t link) {
    const BodyContact& contact = memory.contacts[body_part_of(link)];
    return contact.touches ? &contact : nullptr;
}

Vec3 before_surface(const Vec3& towards, const Vec3& base_m, double length_m,
                    const SpineFrame& above, const BodyContact& contact) {
    constexpr double k_out_mps = 3.0;
    const double least_m = contact.surface_m - contact.normal_ps.dot(base_m);
    return deflect_outward(towards, above.axes.transpose() * contact.normal_ps,
                           least_m / length_m, k_out_mps * k_spine_tick_s / length_m);
}

Vec3 rebound_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps) {
    const double before = normal.dot(velocity_mps);
    const double after = before + normal.dot(correction_mps);
    return std::max(0.0, after - std::max(0.0, before)) * normal;
}

}  // namespace handhold
