#include "systems/body/shared/estimate_body.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/body_constants.hpp"
#include "systems/body/shared/elbow_direction.hpp"
#include "systems/body/shared/level_direction.hpp"
#include "systems/body/shared/rest_hand.hpp"

namespace handhold {

bool has_jumped(const Vec3& before, const Vec3& now, double scale, double dt_s) {
    return is_jump((now - before).norm() / scale, dt_s);
}

EstimateStep estimate_step(double dt_s, double scale, const ArmTuning& tuning) {
    EstimateStep step{dt_s, {}, follow_share(dt_s, tuning.chest_lag_s), {}, scale, tuning};
    for (std::size_t i = 0; i < k_look_filters; ++i) {
        step.look_shares[i] = follow_share(dt_s, body_constants::k_look_lags_s[i]);
    }
    sin_cos(tuning.chest_limit_rad, step.limit.sine, step.limit.cosine);
    return step;
}

namespace {

// Follows the look direction, then estimates the chest. Returns the unfiltered look direction.
Vec3 estimate_chest(const TrackedBody& body, const BodyAxes& axes, const EstimateStep& step,
                    bool reset, ArmMemory& memory, ArmEstimate& out) {
    const ArmTuning& tuning = step.tuning;
    const TrunkView trunk = trunk_view(body, axes);
    Vec3 now_ps = level_look(-axes.head.col(2), axes.head.col(1));
    for (std::size_t i = 0; i < k_look_filters; ++i) {
        Vec3& filtered_ps = memory.looks_ps[i];
        filtered_ps = reset ? now_ps : follow_look(filtered_ps, now_ps, step.look_shares[i]);
    }
    const Quat lean = chest_lean(trunk.up_ps, trunk.lying);
    const Vec3 up_ps = axes.head.col(1);
    const Vec3 talked_ps = chest_facing(
        memory.looks_ps[0], trunk.up_ps == up_ps ? lean : chest_lean(up_ps, trunk.lying), body,
        axes, step.limit);
    ChestCorrection correction = chest_correction(talked_ps, now_ps, memory.looks_ps, body, axes);
    correction.offset.middle_m *= tuning.learned;
    correction.offset.roll *= tuning.learned;
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(tuning.learned * correction.turn_rad, sine, cosine);
    const Vec3 wanted_ps = turned_left(talked_ps, cosine, sine);
    if (reset) {
        memory.facing_ps = wanted_ps;
        memory.chest = correction.offset;
    } else {
        memory.facing_ps = turn_at_most(memory.facing_ps,
                                        follow_look(memory.facing_ps, wanted_ps, step.chest_share),
                                        step.dt_s * tuning.chest_speed_radps);
        ChestOffset& chest = memory.chest;
        chest.middle_m += step.chest_share * (correction.offset.middle_m - chest.middle_m);
        chest.roll += step.chest_share * (correction.offset.roll - chest.roll);
    }
    out.facing_ps = memory.facing_ps;
    out.lying = trunk.lying;
    out.chest_ps = chest_pose(out.facing_ps, lean, memory.chest, body, trunk);
    out.from_neck_m = out.chest_ps.position - neck_pivot(body, axes);
    return now_ps;
}

// The line from shoulder to hand of an arm whose shoulder at rest is at `rest_ps`.
ArmLine line_of(const Vec3& facing, const Vec3& rest_ps, const Vec3& hand_ps, double arm_m,
                const ArmMemory::Arm& memory, const EstimateStep& step) {
    const Vec3 hand_ts = to_facing(facing, hand_ps - rest_ps);
    Vec3 shoulder_ts = step.scale * clavicle_shift(hand_ts / arm_m, step.tuning);
    shoulder_ts += shoulder_follow(hand_ts - shoulder_ts, arm_m, shoulder_ts.norm(), step.tuning);
    const Vec3 reach_ts = hand_ts - shoulder_ts;
    const double distance_m = reach_ts.norm();
    return {shoulder_ts, reach_ts, distance_m,
            distance_m > 1e-6 ? Vec3(reach_ts * (1.0 / distance_m)) : memory.axis_ts};
}

// Inputs of one elbow's estimate.
struct ArmStep {
    HandSide side = HandSide::left;
    bool reset = false;  // true: ignore ArmMemory
    double upper_m = 0.0;
    double forearm_m = 0.0;
    double floor_m = 0.0;  // height of the tracked floor above the resting shoulder
    Vec3 pole_ts = Vec3::Zero();
    const ArmLine& line;
};

// Returns `bend_ts`, turned about the arm's axis by the smallest angle that keeps the elbow above
// `floor_m`.
Vec3 bend_above_floor(const ElbowCircle& circle, const Vec3& axis_ts, const Vec3& bend_ts,
                      double floor_m) {
    const double least_m = floor_m - circle.middle_ts.y();
    if (circle.radius_m * bend_ts.y() >= least_m || circle.radius_m < 1e-6) {
        return bend_ts;
    }
    const Vec3 up = Vec3::UnitY() - axis_ts * axis_ts.y();
    const double length = up.norm();
    if (length < 1e-3) {
        return bend_ts;  // a vertical arm: the elbow's height is fixed
    }
    const Vec3 rising = up * (1.0 / length);
    const double rise = std::clamp(least_m / (circle.radius_m * length), -1.0, 1.0);
    const Vec3 aside = bend_ts - rising * rising.dot(bend_ts);
    const double aside_length = aside.norm();
    const Vec3 level =
        aside_length > 1e-9 ? Vec3(aside * (1.0 / aside_length)) : Vec3(axis_ts.cross(rising));
    return rise * rising + std::sqrt(1.0 - rise * rise) * level;
}

// Updates ArmMemory's elbow direction. Returns the direction to show, which keeps the elbow above
// the floor.
Vec3 estimate_elbow(const EstimateStep& step, const ArmStep& arm, ArmMemory::Arm& memory,
                    ArmEstimate::Arm& out) {
    const ArmTuning& tuning = step.tuning;
    const double dt_s = step.dt_s;
    const ArmLine& line = arm.line;
    const Vec3& axis_ts = line.axis_ts;
    const Vec3 hand_rest_ts = line.shoulder_ts + line.reach_ts;
    out.stretch = std::max(1.0, line.distance_m / (tuning.reach * (arm.upper_m + arm.forearm_m)));
    const ElbowCircle circle = elbow_circle(line.distance_m, axis_ts, out.stretch * arm.upper_m,
                                            out.stretch * arm.forearm_m);
    const Vec3 aside = arm.pole_ts - axis_ts * axis_ts.dot(arm.pole_ts);
    const double length = aside.norm();
    const bool fresh = arm.reset || has_jumped(memory.hand_ts, hand_rest_ts, step.scale, dt_s);
    const Vec3 before_ts = fresh ? any_perpendicular(axis_ts) : carry_bend(memory, axis_ts, tuning);
    const Vec3 wanted_ts = reachable_bend(
        circle, length > 1e-6 ? Vec3(aside * (1.0 / length)) : before_ts, arm.side, tuning);
    if (fresh) {
        memory.bend_ts = wanted_ts;
    } else {
        // A pole nearly parallel to the axis determines no direction, so the filter slows down
        // there.
        const double clear = smooth_step(length / std::max(arm.pole_ts.norm(), 1e-9), 0.0, 0.5);
        memory.bend_ts = turn_bend(
            axis_ts, before_ts, wanted_ts,
            {follow_share(dt_s * clear, tuning.swivel_lag_s), dt_s * tuning.swivel_speed_radps});
    }
    memory.axis_ts = axis_ts;
    memory.hand_ts = hand_rest_ts;
    memory.elbow_ts = circle.middle_ts + circle.radius_m * memory.bend_ts;
    constexpr double k_elbow_m = 0.04;  // half the thickness of an arm, in the player's metres
    return bend_above_floor(circle, axis_ts, memory.bend_ts, arm.floor_m + step.scale * k_elbow_m);
}

}  // namespace

void estimate_body(TrackedBody body, const EstimateStep& step, bool reset, ArmMemory& memory,
                   ArmEstimate& out) {
    const ArmTuning& tuning = step.tuning;
    const BodyAxes axes = axes_of(body);
    const Vec3 look_ps = estimate_chest(body, axes, step, reset, memory, out);
    const Vec3& facing = out.facing_ps;
    const double arm_m = arm_length_m(body.measures);
    const Vec3 right_ps =
        (0.5 * body.measures.shoulder_width_m) * (out.chest_ps.rotation * Vec3::UnitX());
    const std::array<Vec3, k_hand_count> rest_ps = {out.chest_ps.position - right_ps,
                                                    out.chest_ps.position + right_ps};
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        Vec3& hand_ps = body.hands_ps[i].position;
        if (out.arms[i].goal == ArmGoal::rest) {
            hand_ps = within_reach(hand_ps, rest_ps[i], k_rest_reach * arm_m);
        }
        out.arms[i].hand_ps = body.hands_ps[i];
    }
    const auto line_at = [&](std::size_t i) {
        return line_of(facing, rest_ps[i], body.hands_ps[i].position, arm_m, memory.arms[i], step);
    };
    const std::array<ArmLine, k_hand_count> lines = {line_at(0), line_at(1)};
    const BodyView view = view_from(facing, axes);
    const double turned = sine_between(facing, look_ps);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t i = index_of(side);
        const Vec3 pole_ts = elbow_pole(view, side) +
                             tuning.learned * elbow_correction(view, lines, turned, arm_m, side);
        const Vec3 bend_ts =
            estimate_elbow(step,
                           {side, reset, body.measures.upper_arm_m, body.measures.forearm_m,
                            body.floor_m - rest_ps[i].y(), pole_ts, lines[i]},
                           memory.arms[i], out.arms[i]);
        out.arms[i].shoulder_ps = rest_ps[i] + from_facing(facing, lines[i].shoulder_ts);
        out.arms[i].bend_ps = from_facing(facing, bend_ts);
    }
}

}  // namespace handhold
