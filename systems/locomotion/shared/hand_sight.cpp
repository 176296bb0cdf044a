#include "systems/locomotion/shared/hand_sight.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr double k_same_m = 1e-6;

SightLines::Sight sight_between(const SightLines& lines, const Vec3& from_ws, const Vec3& to_ws) {
    constexpr double k_beyond_m = 0.01;
    const Vec3 line = to_ws - from_ws;
    const double length_m = line.norm();
    if (length_m < k_same_m) {
        return SightLines::Sight::clear_beyond;
    }
    const auto hit =
        lines.collision.cast_ray(from_ws, to_ws + (k_beyond_m / length_m) * line, lines.skip);
    if (!hit) {
        return SightLines::Sight::clear_beyond;
    }
    return hit->distance_m > length_m ? SightLines::Sight::clear : SightLines::Sight::blocked;
}

}  // namespace

SightLines::Sight SightLines::sight_of_palm(const Vec3& palm_ws) const {
    const Sight from_outside = sight_between(*this, outside_ws, palm_ws);
    return from_outside == Sight::clear_beyond
               ? from_outside
               : std::max(from_outside, sight_between(*this, head_ws, palm_ws));
}

std::optional<RayHit> SightLines::obstacle(const Vec3& palm_ws) const {
    return collision.cast_ray(outside_ws, palm_ws, skip);
}

bool SightLines::is_free(const Vec3& from_ws, const Vec3& to_ws) const {
    return !collision.cast_ray(from_ws, to_ws, skip);
}

bool SightLines::sees(const Vec3& from_ws, const Vec3& point_ws,
                      std::optional<std::uint64_t> hits_body) const {
    constexpr double k_there_m = 0.01;
    const auto hit = collision.cast_ray(from_ws, point_ws, skip);
    return !hit || (hit->point_ws - point_ws).norm() <= k_there_m || hit->id == hits_body;
}

// Past the palm's side that is a hand's width away in four directions, straight or beside the line.
bool SightLines::can_go_round(const Vec3& from_ws, const Vec3& palm_ws) const {
    constexpr double k_width_m = 0.1;
    const Vec3 line = palm_ws - from_ws;
    if (line.norm() < k_same_m) {
        return false;
    }
    const Vec3 side = k_width_m * line.unitOrthogonal();
    const Vec3 other_side = line.normalized().cross(side);
    const Vec3 offsets[] = {side, -side, other_side, -other_side};
    return std::ranges::any_of(offsets, [&](const Vec3& offset) {
        const Vec3 beside_ws = palm_ws + offset;
        return is_free(beside_ws, palm_ws) &&
               (is_free(from_ws, beside_ws) ||
                (is_free(from_ws, from_ws + offset) && is_free(from_ws + offset, beside_ws)));
    });
}

bool SightLines::may_grip(const Vec3& palm_ws, const Vec3& point_ws,
                          std::optional<std::uint64_t> hits_body) const {
    return sight_of_palm(palm_ws) != Sight::blocked || sees(outside_ws, point_ws, hits_body) ||
           sees(head_ws, point_ws, hits_body) || can_go_round(outside_ws, palm_ws) ||
           can_go_round(head_ws, palm_ws);
}

}  // namespace handhold
