#include "systems/body/shared/elbow_direction.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/two_bone_ik.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/body_constants.hpp"

namespace handhold {
namespace {

// Largest displacement of the shoulder by the clavicle, as a piecewise linear function of the
// hand's distance from the shoulder in arm lengths.
double clavicle_reach_m(double distance) {
    struct Knot {
        // A knot of the function. rise_m: slope from this knot to the next, per arm length.
        double distance, reach_m, rise_m;
    };
    constexpr std::array<Knot, 4> k_curve = {{{1.05, 0.032, (0.070 - 0.032) / (1.2 - 1.05)},
                                              {0.85, 0.018, (0.032 - 0.018) / (1.05 - 0.85)},
                                              {0.7, 0.010, (0.018 - 0.010) / (0.85 - 0.7)},
                                              {0.0, 0.006, (0.010 - 0.006) / 0.7}}};
    for (const Knot& knot : k_curve) {
        if (distance >= knot.distance) {
            return std::min(knot.reach_m + knot.rise_m * (distance - knot.distance), 0.070);
        }
    }
    return k_curve.back().reach_m;
}

constexpr double k_near_bend_cosine = 0.95;  // share_of_line is used for larger cosines

}  // namespace

Vec3 clavicle_shift(const Vec3& hand, const ArmTuning& tuning) {
    const double distance = hand.norm();
    const double reach_m = tuning.clavicle_share * clavicle_reach_m(distance);
    return Vec3(0.0, hand.y() + tuning.clavicle_lift, hand.z()) *
           (reach_m / std::max(distance, 0.3));
}

Vec3 shoulder_follow(const Vec3& hand_m, double arm_m, double shifted_m, const ArmTuning& tuning) {
    const double distance = hand_m.norm();
    const double beyond = distance - tuning.reach * arm_m;
    const double most_m = tuning.shoulder_follow_m - shifted_m;
    return beyond <= 0.0 || most_m <= 0.0 ? Vec3(Vec3::Zero())
                                          : Vec3(hand_m * (std::min(beyond, most_m) / distance));
}

Vec3 elbow_pole(const BodyView& view, HandSide side) {
    using namespace body_constants;
    const std::size_t own = index_of(side);
    // On a right hand, back x fingers points to the thumb's side; on a left hand, away from it.
    const Vec3 thumb = side == HandSide::right ? view.back[own].cross(view.fingers[own])
                                               : view.fingers[own].cross(view.back[own]);
    const Vec3 rest = mirrored_if_left(Vec3(k_pole_rest[0], k_pole_rest[1], k_pole_rest[2]), side);
    return rest + k_pole_fingers * view.fingers[own] + k_pole_back * view.back[own] +
           k_pole_thumb * thumb;
}

// The order is that of tools/lab/bodies/estimator.py.
Vec3 elbow_correction(const BodyView& view, const std::array<ArmLine, k_hand_count>& lines,
                      double turned, double arm_m, HandSide side) {
    const std::size_t own = index_of(side);
    const ArmLine& line = lines[own];
    SideInputs<body_constants::k_elbow_inputs> inputs(side);
    inputs.add(line.axis_ts);
    inputs.add(line.distance_m / arm_m);
    inputs.add(view.fingers[own]);
    inputs.add(view.back[own]);
    inputs.add_products(line.axis_ts, view.fingers[own]);
    inputs.add_products(line.axis_ts, view.back[own]);
    inputs.add(view.head_up);
    inputs.add_lateral(turned);
    inputs.add(lines[1 - own].reach_ts * (1.0 / arm_m));
    const auto answer = evaluate(body_constants::k_elbow_network, inputs.values());
    // Near the shoulder wrists bend most, and the training data's wrists are synthetic: there the
    // formula without a network is better for people who were not fitted.
    const double trust =
        answer.familiarity * smooth_step(line.distance_m / arm_m, body_constants::k_near_shoulder,
                                         body_constants::k_off_shoulder);
    const auto value = [&](std::size_t i) { return trust * static_cast<double>(answer.values[i]); };
    return mirrored_if_left(Vec3(value(0), value(1), value(2)), side);
}

ElbowCircle elbow_circle(double distance_m, const Vec3& axis_ts, double upper_m, double forearm_m) {
    const MiddleJoint elbow = middle_joint(distance_m, upper_m, forearm_m);
    return {axis_ts, axis_ts * elbow.along_m, elbow.aside_m};
}

Vec3 reachable_bend(const ElbowCircle& circle, const Vec3& bend_ts, HandSide side,
                    const ArmTuning& tuning) {
    // The cone's axis may have any length: the inequality scales with it.
    Vec3 cone_ts = tuning.elbow_cone;
    cone_ts.x() *= side == HandSide::right ? 1.0 : -1.0;
    const double upper2 = circle.middle_ts.squaredNorm() + circle.radius_m * circle.radius_m;
    // Minimum displacement of the elbow from the circle's middle along the cone's axis that keeps
    // the upper arm inside the cone.
    const double needs = std::sqrt(upper2 * cone_ts.squaredNorm()) * tuning.elbow_cone_cosine -
                         circle.middle_ts.dot(cone_ts);
    if (circle.radius_m * bend_ts.dot(cone_ts) >= needs) {
        return bend_ts;
    }
    const Vec3 aside = cone_ts - circle.axis_ts * circle.axis_ts.dot(cone_ts);
    const double length = aside.norm();
    if (length < 1e-6) {
        return bend_ts;
    }
    // Starts at the direction deepest inside the cone and turns towards `bend_ts` until the cone's
    // boundary.
    const Vec3 best = aside / length;
    const double cosine = std::clamp(needs / std::max(circle.radius_m * length, 1e-9), -1.0, 1.0);
    const Vec3 square = circle.axis_ts.cross(best);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return cosine * best + (square.dot(bend_ts) < 0.0 ? -sine : sine) * square;
}

Vec3 carry_bend(const ArmMemory::Arm& arm, const Vec3& axis_ts, const ArmTuning& tuning) {
    const double cosine = arm.axis_ts.dot(axis_ts);
    // Shortest rotation from the old axis to the new one, simplified for a vector perpendicular to
    // the old axis.
    const Vec3 carried = cosine > -0.5
                             ? Vec3(arm.bend_ts - (arm.axis_ts + axis_ts) *
                                                      (axis_ts.dot(arm.bend_ts) / (1.0 + cosine)))
                             : Vec3(rotation_between(arm.axis_ts, axis_ts) * arm.bend_ts);
    // Distance of the elbow from the old line, divided by the length of the upper arm. If it is
    // small, the elbow's position does not determine its direction.
    const double by_upper = 1.0 / std::max(arm.elbow_ts.norm(), 1e-9);
    const double bent = arm.elbow_ts.dot(arm.bend_ts) * by_upper;
    const double stays = tuning.elbow_inertia * smooth_step(bent, 0.3, 0.8);
    const Vec3 side_then = (1.0 - stays) * carried + (stays * by_upper) * arm.elbow_ts;
    const Vec3 bend = side_then - axis_ts * axis_ts.dot(side_then);
    const double length = bend.norm();
    return length > 1e-6 ? Vec3(bend * (1.0 / length)) : any_perpendicular(axis_ts);
}

Vec3 turn_bend(const Vec3& axis_ts, const Vec3& bend_ts, const Vec3& wanted_ts,
               const BendTurn& turn) {
    const Vec3 side = axis_ts.cross(bend_ts);
    const double sine_now = side.dot(wanted_ts);
    const double cosine_now = bend_ts.dot(wanted_ts);
    const double share = share_of_line(turn.share, cosine_now);
    double sine = share * sine_now;
    double cosine = 1.0 - share * (1.0 - cosine_now);
    if (!(cosine_now > k_near_bend_cosine && std::abs(sine) < 0.98 * turn.most_rad)) {
        const double angle = arc_tangent2(sine_now, cosine_now);
        sin_cos(std::clamp(turn.share * angle, -turn.most_rad, turn.most_rad), sine, cosine);
    }
    const Vec3 turned = cosine * bend_ts + sine * side;
    return turned * (1.0 / turned.norm());
}

}  // namespace handhold
