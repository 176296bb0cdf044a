// Bullet's own caster takes the same steps, but stops a millimetre before the touch, misses a touch
// of what turns fast now and then (1 of 600 capsules), moves only bodies that turn about their
// middle, and counts its searches in a global, so that two threads could not sweep at a time.
#include "engine/collision/bullet_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr double k_sweep_touch_m = 1e-6;
constexpr int k_steps =
    128;  // glancing turns close in slowly; the touch given is then early, never late
constexpr double k_worn_share = 0.5;  // of the gap that a direction was found for

// How far the sphere about a goes before it nears a triangle: cheap steps, whatever a's turn, that
// leave most triangles behind. nullopt where the sphere never does.
std::optional<double> skip_free_travel(const RelativeMotion& motion, const Corners& corners_ns,
                                       double reach_m, double limit) {
    constexpr int k_cheap_steps = 8;
    double fraction = 0.0;
    for (int step = 0; step < k_cheap_steps; ++step) {
        const Vec3 centre = motion.from_ns() + fraction * motion.move();
        const Vec3 state = centre - closest_on_triangle(centre, corners_ns);
        const double distance = state.norm();
        const double gap = distance - reach_m - k_sweep_touch_m;
        if (gap <= 0.01 * reach_m) {
            break;
        }
        const double closing_m = -motion.move().dot(state) / distance;
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

// What keeps a apart from b along a direction; negative where it does not.
double gap_along(const Convex& a, const Convex& b, const Vec3& normal) {
    return normal.dot(a.support(-normal) - b.support(normal)) - a.radius_m - b.radius_m;
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

std::optional<Approach> begin_approach(const ConvexPart& a, const RelativeMotion& motion,
                                       const Convex& b, double limit) {
    Approach approach;
    if (b.corners_ns != nullptr) {
        const auto free_fraction =
            skip_free_travel(motion, *b.corners_ns, a.extent().radius_m, limit);
        if (!free_fraction) {
            return std::nullopt;
        }
        approach.fraction = *free_fraction;
    }
    return approach;
}

ApproachState advance(const ConvexPart& a, const RelativeMotion& motion, const Convex& b,
                      double limit, Approach& approach) {
    const Convex placed = a.at(motion.at(approach.fraction));
    // A direction that keeps them apart is as safe as the best one; it is kept until half of its
    // gap is gone: finding another costs ten times as much.
    double gap = approach.gap_m > 0.0 ? gap_along(placed, b, approach.impact.normal) : 0.0;
    if (!(gap > std::max(k_worn_share * approach.gap_m, 10.0 * k_sweep_touch_m))) {
        const CoreSeparation separation = separate(placed, b);
        gap = separation.separation_m - placed.radius_m - b.radius_m;
        approach.gap_m = gap;
        approach.impact.fraction = approach.fraction;
        approach.impact.normal = separation.normal;
        approach.impact.point_b_ns = separation.point_b_ns + b.radius_m * separation.normal;
        if (!(gap > k_sweep_touch_m)) {
            return ApproachState::touches;
        }
    }
    if (++approach.steps == k_steps) {
        return ApproachState::touches;
    }
    // Turning carries a point along the normal no faster than this, wherever it turns to.
    const Vec3& normal = approach.impact.normal;
    const double turning_m = motion.turn_rad().cross(normal).norm() * a.arm_m();
    const double closing_m = turning_m - motion.move().dot(normal);
    if (!(closing_m > 0.0)) {
        return ApproachState::misses;
    }
    approach.fraction += (gap - 0.5 * k_sweep_touch_m) / closing_m;
    return approach.fraction <= limit ? ApproachState::continues : ApproachState::misses;
}

std::optional<Impact> time_of_impact(const ConvexPart& a, const RelativeMotion& motion,
                                     const Convex& b, double limit) {
    std::optional<Approach> approach = begin_approach(a, motion, b, limit);
    ApproachState state = approach ? ApproachState::continues : ApproachState::misses;
    while (state == ApproachState::continues) {
        state = advance(a, motion, b, limit, *approach);
    }
    return state == ApproachState::touches ? std::optional(approach->impact) : std::nullopt;
}

}  // namespace handhold
