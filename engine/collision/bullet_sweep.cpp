// Bullet's btContinuousConvexCollision advances in the same way, but is not used: it stops a
// millimetre early, misses some impacts of fast rotating shapes (1 of 600 capsules) and supports
// only rotation about the shape's own centre. It also counts iterations in a global, which is a
// data race.
#include "engine/collision/bullet_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/bullet_box_separation.hpp"

namespace handhold {
namespace {

constexpr double k_sweep_touch_m = 1e-6;
// Limit of steps; rotations that nearly graze the other shape converge slowly. At the limit the
// sweep reports a touch that is too early, never too late.
constexpr int k_steps = 128;
// A new separating direction is computed when the gap is below this share of the last computed gap.
constexpr double k_reuse_ratio = 0.5;

// Moves the moving shape's bounding sphere (radius `reach_m`) towards the triangle, in cheap steps
// that ignore rotation. Returns the fraction of the motion that is certainly free. nullopt if the
// sphere does not reach the triangle before the fraction `limit`, as with most triangles.
std::optional<double> skip_free_travel(const RelativeMotion& motion, const Corners& corners_ns,
                                       double reach_m, double limit) {
    constexpr int k_cheap_steps = 8;
    double fraction = 0.0;
    for (int step = 0; step < k_cheap_steps; ++step) {
        const Vec3 centre = motion.from_ns() + fraction * motion.move();
        const Vec3 offset = centre - closest_on_triangle(centre, corners_ns);
        const double distance = offset.norm();
        const double gap = distance - reach_m - k_sweep_touch_m;
        if (gap <= 0.01 * reach_m) {
            break;
        }
        const double closing_m = -motion.move().dot(offset) / distance;
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

// Upper bound of the closing speed of a and b along `normal`, in metres per whole motion.
// |omega x normal| arm bounds the rotation's contribution, for every orientation that a passes
// through.
double max_closing_m(const ConvexPart& a, const RelativeMotion& motion, const Vec3& normal) {
    return motion.turn_rad().cross(normal).norm() * a.arm_m() - motion.move().dot(normal);
}

// Separation of a and b along `normal`; negative if the normal does not separate them.
double gap_along(const Convex& a, const Convex& b, const Vec3& normal) {
    return normal.dot(a.support(-normal) - b.support(normal)) - a.radius_m - b.radius_m;
}

// Measures the distance of the shapes at the approach's fraction.
void measure(const Convex& placed, const Convex& b, Approach& approach) {
    const CoreSeparation separation = separate(placed, b);
    approach.gap_m = separation.separation_m - placed.radius_m - b.radius_m;
    approach.impact.fraction = approach.fraction;
    approach.impact.normal = separation.normal;
    approach.impact.point_b_ns = separation.point_b_ns + b.radius_m * separation.normal;
}

// Finds a direction that separates the shapes, and their gap along it. Any such direction gives a
// safe step. Boxes have one in closed form, without their distance.
void find_gap(const Convex& placed, const Convex& b, Approach& approach) {
    if (are_boxes(placed, b)) {
        const BoxAxis axis = find_box_axis(placed, b, std::numeric_limits<double>::infinity());
        if (axis.separation_m > k_sweep_touch_m) {
            approach.gap_m = axis.separation_m;
            approach.impact.normal = axis.normal;
            return;
        }
    }
    measure(placed, b, approach);
}

}  // namespace

RelativeMotion::RelativeMotion(const Pose& from_ns, const Pose& to_ns)
    : from_(from_ns),
      to_(to_ns),
      move_(to_ns.position - from_ns.position),
      // Computed in a's frame, where the rotation's axis is the same at every fraction.
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
                                       const Convex& b, const SweepLimit& limit) {
    Approach approach;
    if (b.corners_ns != nullptr) {
        const auto free_fraction =
            skip_free_travel(motion, *b.corners_ns, a.extent().radius_m, limit.fraction);
        if (!free_fraction) {
            return std::nullopt;
        }
        approach.fraction = *free_fraction;
        return approach;
    }
    const Convex placed = a.at(motion.at(0.0));
    const Vec3 offset = placed.centre_ns() - b.centre_ns();
    const double distance = offset.norm();
    if (distance > 0.0) {
        const Vec3 normal = offset / distance;
        const double gap = gap_along(placed, b, normal);
        const double closing_m = max_closing_m(a, motion, normal);
        const bool may_graze = limit.grazing_m > 0.0 && closing_m - gap < limit.grazing_m;
        if (gap > k_sweep_touch_m &&
            (may_graze || gap - k_sweep_touch_m > limit.fraction * closing_m)) {
            return std::nullopt;
        }
    }
    return approach;
}

ApproachState advance(const ConvexPart& a, const RelativeMotion& motion, const Convex& b,
                      const SweepLimit& limit, Approach& approach) {
    const Convex placed = a.at(motion.at(approach.fraction));
    // Every separating direction gives a safe step. The last direction is reused until half of its
    // gap is consumed, because a new separation query costs ten times as much.
    double gap = approach.gap_m > 0.0 ? gap_along(placed, b, approach.impact.normal) : 0.0;
    if (!(gap > std::max(k_reuse_ratio * approach.gap_m, 10.0 * k_sweep_touch_m))) {
        find_gap(placed, b, approach);
        gap = approach.gap_m;
        if (!(gap > k_sweep_touch_m)) {
            return ApproachState::touches;
        }
    }
    if (++approach.steps == k_steps) {
        measure(placed, b, approach);
        return ApproachState::touches;
    }
    const double closing_m = max_closing_m(a, motion, approach.impact.normal);
    // Along this direction, the shapes overlap by at most `left_m` before the end of the motion,
    // and no more along the shortest way out.
    const double left_m = (1.0 - approach.fraction) * closing_m - gap;
    const bool may_graze = limit.grazing_m > 0.0 && left_m < limit.grazing_m;
    if (!(closing_m > 0.0) || may_graze) {
        return ApproachState::misses;
    }
    approach.fraction += (gap - 0.5 * k_sweep_touch_m) / closing_m;
    return approach.fraction <= limit.fraction ? ApproachState::continues : ApproachState::misses;
}

std::optional<Impact> time_of_impact(const ConvexPart& a, const RelativeMotion& motion,
                                     const Convex& b, const SweepLimit& limit) {
    std::optional<Approach> approach = begin_approach(a, motion, b, limit);
    ApproachState offset = approach ? ApproachState::continues : ApproachState::misses;
    while (offset == ApproachState::continues) {
        offset = advance(a, motion, b, limit, *approach);
    }
    return offset == ApproachState::touches ? std::optional(approach->impact) : std::nullopt;
}

}  // namespace handhold
