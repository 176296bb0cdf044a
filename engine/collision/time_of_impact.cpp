// Source: conservative advancement, Mirtich 1996. The distance is exact, so steps are as long as
// the rotation's bound allows.
#include "engine/collision/time_of_impact.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr double k_touch_m = 1e-6;
constexpr int k_steps =
    64;  // glancing turns close in slowly; the fraction reached is then early, never late

// How far from the centre rotation carries a point of the core.
double turning_reach(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.half_m.norm();
        case ShapeKind::capsule:
            return shape.half_height_m;
        default:
            return 0.0;
    }
}

// How far the sphere about a goes before it nears b: cheap steps, whatever a's turn, that leave
// most triangles behind. nullopt where the sphere never does.
std::optional<double> skip_free_way(const RelativeMotion& motion, const ConvexCore& b,
                                    double reach_m, double limit) {
    constexpr int k_cheap_steps = 8;
    double fraction = 0.0;
    for (int step = 0; step < k_cheap_steps; ++step) {
        const Vec3 centre = motion.from_ns() + fraction * motion.move();
        const Vec3 way = centre - closest_on_core(centre, b);
        const double distance = way.norm();
        const double gap = distance - reach_m - k_touch_m;
        if (gap <= 0.01 * reach_m) {
            break;
        }
        const double closing_m = -motion.move().dot(way) / distance;
        if (closing_m <= 0.0) {
            return std::nullopt;
        }
        fraction += gap / closing_m;
        if (fraction > limit) {
            return std::nullopt;
        }
    }
    return fraction;
}

}  // namespace

RelativeMotion::RelativeMotion(const Pose& from_ns, const Pose& to_ns)
    : from_(from_ns),
      to_(to_ns),
      move_(to_ns.position - from_ns.position),
      // In a's frame first, where interpolation turns about a fixed axis; that axis is the same at
      // every fraction.
      turn_(from_ns.rotation * rotation_to_vector(from_ns.rotation.conjugate() * to_ns.rotation)) {}

Pose RelativeMotion::at(double fraction) const {
    if (fraction >= 1.0) {
        return to_;
    }
    return fraction <= 0.0 ? from_ : interpolate(from_, to_, fraction);
}

Vec3 RelativeMotion::velocity_at(const Vec3& point_ns, double fraction) const {
    return move_ + turn_.cross(point_ns - (from_.position + fraction * move_));
}

std::optional<Impact> time_of_impact(const Shape& a, const RelativeMotion& motion,
                                     const ConvexCore& b, double limit) {
    const double turning_m = motion.turn_rad().norm() * turning_reach(a);
    const std::optional<double> free_way =
        skip_free_way(motion, b, bounding_radius(a) + b.radius_m, limit);
    if (!free_way) {
        return std::nullopt;
    }
    Impact impact;
    impact.fraction = *free_way;
    for (int step = 0; step < k_steps; ++step) {
        const ConvexCore core = make_core(a, motion.at(impact.fraction));
        const CoreSeparation separation = *separate_cores(core, b);
        const double gap = separation.separation_m - core.radius_m - b.radius_m;
        impact.normal = separation.normal;
        impact.point_b_ns = separation.point_b_ns + b.radius_m * separation.normal;
        impact.overlap = separation.overlap;
        if (gap <= k_touch_m) {
            return impact;
        }
        // No point of a nears the plane between the two faster than this.
        const double closing_m = turning_m - motion.move().dot(separation.normal);
        if (closing_m <= 0.0) {
            return std::nullopt;
        }
        impact.fraction += (gap - 0.5 * k_touch_m) / closing_m;
        if (impact.fraction > limit) {
            return std::nullopt;
        }
    }
    return impact;
}

}  // namespace handhold
