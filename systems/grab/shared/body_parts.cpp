#include "systems/grab/shared/body_parts.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

struct CapsulePoint {
    Vec3 point_ws;
    Vec3 normal_ws;
    double distance_m = 0.0;
};

CapsulePoint closest_on(const PartCapsule& capsule, const Vec3& point_ws) {
    const Vec3 point_bs = inverse_transform_point(capsule.frame_ws, point_ws);
    const double length2 = capsule.end_bs.squaredNorm();
    const double along =
        length2 > 0.0 ? std::clamp(point_bs.dot(capsule.end_bs) / length2, 0.0, 1.0) : 0.0;
    const Vec3 on_axis_bs = along * capsule.end_bs;
    const Vec3 out_bs = point_bs - on_axis_bs;
    const double distance_m = out_bs.norm();
    constexpr double k_on_axis_m = 1e-9;
    const Vec3 normal_bs = distance_m > k_on_axis_m ? Vec3(out_bs / distance_m)
                           : length2 > 0.0          ? Vec3(capsule.end_bs.unitOrthogonal())
                                                    : Vec3(Vec3::UnitY());
    return {transform_point(capsule.frame_ws, on_axis_bs + capsule.radius_m * normal_bs),
            capsule.frame_ws.rotation * normal_bs, distance_m - capsule.radius_m};
}

// The smaller root t of |from + t along| = radius, if the line meets the sphere or circle.
// `along` need not be a unit vector.
std::optional<double> entry_of(const Vec3& from, const Vec3& along, double radius_m) {
    const double a = along.squaredNorm();
    const double b = from.dot(along);
    const double discriminant = b * b - a * (from.squaredNorm() - radius_m * radius_m);
    constexpr double k_least = 1e-18;
    if (a < k_least || discriminant < 0.0) {
        return std::nullopt;
    }
    return (-b - std::sqrt(discriminant)) / a;
}

// Where a ray enters the capsule: through its side, or through the sphere at either end.
std::optional<CapsulePoint> ray_hit(const PartCapsule& capsule, const Vec3& from_ws,
                                    const Vec3& to_ws) {
    const double ray_m = (to_ws - from_ws).norm();
    if (ray_m <= 0.0 || closest_on(capsule, from_ws).distance_m < 0.0) {
        return std::nullopt;
    }
    const Vec3 from_bs = inverse_transform_point(capsule.frame_ws, from_ws);
    const Vec3 along_bs = capsule.frame_ws.rotation.conjugate() * ((to_ws - from_ws) / ray_m);
    double first_m = ray_m;
    bool hits = false;
    const auto offer = [&](const std::optional<double>& at_m) {
        if (at_m && *at_m >= 0.0 && *at_m <= first_m) {
            first_m = *at_m;
            hits = true;
        }
    };
    offer(entry_of(from_bs, along_bs, capsule.radius_m));
    offer(entry_of(from_bs - capsule.end_bs, along_bs, capsule.radius_m));
    const double length_m = capsule.end_bs.norm();
    if (length_m > 0.0) {
        const Vec3 axis = capsule.end_bs / length_m;
        const auto across = [&](const Vec3& v) { return Vec3(v - axis * axis.dot(v)); };
        const auto side_m = entry_of(across(from_bs), across(along_bs), capsule.radius_m);
        const double at_m = side_m ? axis.dot(from_bs + *side_m * along_bs) : -1.0;
        if (at_m >= 0.0 && at_m <= length_m) {
            offer(side_m);
        }
    }
    if (!hits) {
        return std::nullopt;
    }
    CapsulePoint hit = closest_on(capsule, from_ws + (first_m / ray_m) * (to_ws - from_ws));
    hit.distance_m = first_m;
    return hit;
}

}  // namespace

Pose follow_part(const Pose& from_ps, const Pose& to_ps, const Vec3& anchor_bs,
                 const PartStep& step) {
    const Vec3 anchor_ps = transform_point(from_ps, anchor_bs);
    const Vec3 way = transform_point(to_ps, anchor_bs) - anchor_ps;
    const double way_m = way.norm();
    const double share = way_m * step.share > step.max_m ? step.max_m / way_m : step.share;
    if (share >= 1.0) {
        return to_ps;
    }
    const Quat rotation = interpolate(from_ps.rotation, to_ps.rotation, share);
    return {anchor_ps + share * way - rotation * anchor_bs, rotation};
}

Pose GrippableBodies::part_ps(Entity player, BodyPart part) const {
    const PartCapsule capsule = part_capsule(bodies.at(player), measures.at(player), part);
    return inverse(origin.at(player).pose_ws) * capsule.frame_ws;
}

template <typename Test>
std::optional<PartHit> GrippableBodies::nearest(const Vec3& near_ws, double within_m, Skip skip,
                                                const Test& test) const {
    std::optional<PartHit> best;
    for (std::size_t index = 0; index < bodies.size(); ++index) {
        const Entity player = bodies.owners()[index];
        const GrippableBody& body = bodies.elements()[index];
        const std::uint64_t id = persistent_id.at(player).value;
        if (std::ranges::find(skip, id) != skip.end()) {
            continue;
        }
        const BodyMeasures& size = measures.at(player);
        const Vec3 head_ws =
            transform_point(origin.at(player).pose_ws, head.at(player).start_ps.position);
        if ((head_ws - near_ws).norm() > within_m + k_grippable_eyes * size.eye_height_m) {
            continue;
        }
        for (std::size_t i = 0; i < k_gripped_parts; ++i) {
            const auto part = static_cast<BodyPart>(i);
            const PartCapsule capsule = part_capsule(body, size, part);
            const std::optional<CapsulePoint> hit = test(capsule);
            if (hit && (!best || hit->distance_m < best->distance_m ||
                        (hit->distance_m == best->distance_m && id < best->id))) {
                best = PartHit{id, part, hit->point_ws, hit->normal_ws, hit->distance_m};
            }
        }
    }
    return best;
}

std::optional<PartHit> GrippableBodies::cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                                 Skip skip) const {
    return nearest(from_ws, (to_ws - from_ws).norm(), skip,
                   [&](const PartCapsule& capsule) { return ray_hit(capsule, from_ws, to_ws); });
}

std::optional<PartHit> GrippableBodies::closest_point(const Vec3& point_ws, double max_distance_m,
                                                      Skip skip) const {
    return nearest(point_ws, max_distance_m, skip,
                   [&](const PartCapsule& capsule) -> std::optional<CapsulePoint> {
                       const CapsulePoint found = closest_on(capsule, point_ws);
                       return found.distance_m <= max_distance_m ? std::optional(found)
                                                                 : std::nullopt;
                   });
}

}  // namespace handhold
