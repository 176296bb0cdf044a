#include "systems/grab/shared/hand_sight.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr double k_same_m = 1e-6;

SightLines::Sight sight_between(const SightLines& lines, const Vec3& from_ws, const Vec3& to_ws) {
    const Vec3 line = to_ws - from_ws;
    const double length_m = line.norm();
    if (length_m < k_same_m) {
        return SightLines::Sight::clear_beyond;
    }
    const auto hit = lines.surfaces.cast_ray(
        from_ws, to_ws + (lines.scale * k_sight_beyond_m / length_m) * line, lines.skip);
    if (!hit) {
        return SightLines::Sight::clear_beyond;
    }
    return hit->distance_m > length_m ? SightLines::Sight::clear : SightLines::Sight::blocked;
}

}  // namespace

SightLines::Sight SightLines::sight_of_palm(const Vec3& palm_ws) const {
    const Sight from_outside = sight_between(*this, outside_ws, palm_ws);
    return from_outside == Sight::blocked ? sight_between(*this, head_ws, palm_ws) : from_outside;
}

// The first surface on the line to the palm, or the one straight above the palm if that is in sight
// too: a hand that slid along inside a wall grips the wall where it is.
std::optional<RayHit> SightLines::entry_from(const Vec3& from_ws, const Vec3& palm_ws) const {
    constexpr double k_above_m = 0.01;
    const auto first = surfaces.cast_ray(from_ws, palm_ws, skip);
    if (!first) {
        return std::nullopt;
    }
    const double depth_m = (first->point_ws - palm_ws).dot(first->normal_ws);
    const Vec3 above_ws = palm_ws + (depth_m + scale * k_above_m) * first->normal_ws;
    const auto straight = surfaces.cast_ray(above_ws, palm_ws, skip);
    return straight && is_free(from_ws, above_ws) ? straight : first;
}

std::optional<RayHit> SightLines::entry(const Vec3& palm_ws) const {
    const auto from_outside = entry_from(outside_ws, palm_ws);
    const auto from_head = entry_from(head_ws, palm_ws);
    if (!from_outside || !from_head) {
        return from_outside ? from_outside : from_head;
    }
    const auto distance_m = [&](const RayHit& hit) { return (hit.point_ws - palm_ws).norm(); };
    return distance_m(*from_head) < distance_m(*from_outside) ? from_head : from_outside;
}

bool SightLines::is_free(const Vec3& from_ws, const Vec3& to_ws) const {
    return !surfaces.cast_ray(from_ws, to_ws, skip);
}

bool SightLines::sees(const Vec3& from_ws, const Vec3& point_ws, std::uint64_t body_id,
                      Needs needs) const {
    constexpr double k_there_m = 0.01;
    const auto hit = surfaces.cast_ray(from_ws, point_ws, skip);
    return !hit || (hit->point_ws - point_ws).norm() <= scale * k_there_m ||
           (needs == Needs::any_point && hit->id == body_id);
}

// Tests four detours that run a hand's width beside the line and then sideways to the palm. If
// another body blocks the line, the sideways part may hit the body that the hand would grip.
bool SightLines::can_go_round(const Vec3& from_ws, const Vec3& palm_ws,
                              std::uint64_t body_id) const {
    constexpr double k_width_m = 0.1;
    const Vec3 line = palm_ws - from_ws;
    if (line.norm() < k_same_m) {
        return false;
    }
    const auto obstacle = surfaces.cast_ray(from_ws, palm_ws, skip);
    const bool may_touch = !obstacle || obstacle->id != body_id;
    const auto reaches_palm = [&](const Vec3& beside_ws) {
        const auto hit = surfaces.cast_ray(beside_ws, palm_ws, skip);
        return !hit || (may_touch && hit->id == body_id);
    };
    const Vec3 side = (scale * k_width_m) * line.unitOrthogonal();
    const Vec3 other_side = line.normalized().cross(side);
    const Vec3 offsets[] = {side, -side, other_side, -other_side};
    return std::ranges::any_of(offsets, [&](const Vec3& offset) {
        const Vec3 beside_ws = palm_ws + offset;
        return reaches_palm(beside_ws) &&
               (is_free(from_ws, beside_ws) ||
                (is_free(from_ws, from_ws + offset) && is_free(from_ws + offset, beside_ws)));
    });
}

bool SightLines::may_grip(const Vec3& palm_ws, const Vec3& point_ws, std::uint64_t body_id,
                          Needs needs) const {
    return sight_of_palm(palm_ws) != Sight::blocked || sees(outside_ws, point_ws, body_id, needs) ||
           sees(head_ws, point_ws, body_id, needs) || can_go_round(outside_ws, palm_ws, body_id) ||
           can_go_round(head_ws, palm_ws, body_id);
}

}  // namespace handhold
