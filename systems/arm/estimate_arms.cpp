// The model and its constants were fitted to motion capture of head, hands, chest and elbows
// (docs/decisions/, 34 and 43). The model follows rows 19 to 22 of the talk. In addition, the chest
// turns perpendicular to the line between the hands.
#include "systems/arm/estimate_arms.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/two_bone_ik.hpp"
#include "engine/ecs/join.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

double cross_y(const Vec3& a, const Vec3& b) { return a.z() * b.x() - a.x() * b.z(); }

// Turns a level vector about +Y by the angle with the given cosine and sine.
Vec3 turn_level(const Vec3& v, double cosine, double sine) {
    return {cosine * v.x() + sine * v.z(), 0.0, cosine * v.z() - sine * v.x()};
}

// to_facing converts a play-space vector to axes whose -Z is the level direction `facing`;
// from_facing converts back.
Vec3 to_facing(const Vec3& facing, const Vec3& v) {
    return {facing.x() * v.z() - facing.z() * v.x(), v.y(),
            -(facing.x() * v.x() + facing.z() * v.z())};
}
Vec3 from_facing(const Vec3& facing, const Vec3& v) {
    return {-(facing.z() * v.x() + facing.x() * v.z()), v.y(),
            facing.x() * v.x() - facing.z() * v.z()};
}

// Normalises a level vector.
Vec3 level_unit(const Vec3& v) {
    const double by = 1.0 / std::sqrt(v.x() * v.x() + v.z() * v.z());
    return {v.x() * by, 0.0, v.z() * by};
}

// Rotation about +Y that turns -Z to the level direction `facing`. Uses half-angle formulas instead
// of trigonometry.
Quat level_rotation(const Vec3& facing) {
    const double cosine = -facing.z();
    const double sine = -facing.x();
    if (cosine > -0.5) {
        return unit_quat(1.0 + cosine, 0.0, sine, 0.0);
    }
    return unit_quat(std::abs(sine), 0.0, std::copysign(1.0 - cosine, sine), 0.0);
}

// Largest displacement of the shoulder by the clavicle, as a piecewise linear function of the
// hand's distance from the shoulder in arm lengths.
double clavicle_reach_m(double distance) {
    struct Knot {
        // rise_m: slope from this knot to the next, per arm length
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

constexpr double k_near_cosine = 0.95;  // for larger cosines, share_of_line replaces trigonometry

bool has_jumped(const Vec3& before, const Vec3& now, double dt_s) {
    return is_jump((now - before).norm(), dt_s);
}

// Head and hands at one time.
struct Player {
    Pose head_ps;
    std::array<Pose, k_hand_count> hands_ps;
    const BodyMeasures& measures;
};

// Values of one time step that are the same for all players.
struct Step {
    double dt_s = 0.0;
    double look_share = 0.0;  // filter gain for the head's direction
    double limit_sine = 0.0;  // sine and cosine of ArmTuning::chest_limit_rad
    double limit_cosine = 1.0;
    const ArmTuning& tuning;
};
Step step_of(double dt_s, const ArmTuning& tuning) {
    Step step{dt_s, follow_share(dt_s, tuning.head_lag_s), 0.0, 1.0, tuning};
    sin_cos(tuning.chest_limit_rad, step.limit_sine, step.limit_cosine);
    return step;
}

// Inputs of one arm's estimate.
struct ArmStep {
    HandSide side = HandSide::left;
    bool reset = false;  // true: ignore ArmMemory
    double upper_m = 0.0;
    double arm_m = 0.0;
    const Vec3& facing_ps;  // level; -Z of the torso axes
    Vec3 rest_ps = Vec3::Zero();
    const Vec3& hand_ps;
    const Mat3& hand_axes_ps;
};

void estimate_arm(const Step& step, const ArmStep& arm, ArmMemory::Arm& memory,
                  ArmEstimate::Arm& out) {
    const ArmTuning& tuning = step.tuning;
    const double arm_m = arm.arm_m;
    const double dt_s = step.dt_s;
    const Vec3& facing = arm.facing_ps;
    const Vec3 hand_rest_ts = to_facing(facing, arm.hand_ps - arm.rest_ps);
    Vec3 shoulder_ts = clavicle_shift(hand_rest_ts / arm_m, tuning);
    shoulder_ts += shoulder_follow(hand_rest_ts - shoulder_ts, arm_m, tuning);
    const Vec3 reach_ts = hand_rest_ts - shoulder_ts;
    const double distance = reach_ts.norm();
    const Vec3 axis_ts = distance > 1e-6 ? Vec3(reach_ts * (1.0 / distance)) : memory.axis_ts;
    const Vec3 pole_ts = elbow_pole(facing, arm.hand_axes_ps, arm.side, tuning);
    const double stretch = std::max(1.0, distance / (tuning.reach * arm_m));
    const ElbowCircle circle =
        elbow_circle(distance, axis_ts, stretch * arm.upper_m, stretch * (arm_m - arm.upper_m));
    const Vec3 aside = pole_ts - axis_ts * axis_ts.dot(pole_ts);
    const double length = aside.norm();
    const bool fresh = arm.reset || has_jumped(memory.hand_ts, hand_rest_ts, dt_s);
    const Vec3 before_ts = fresh ? any_perpendicular(axis_ts) : carry_bend(memory, axis_ts, tuning);
    const Vec3 wanted_ts = reachable_bend(
        circle, length > 1e-6 ? Vec3(aside * (1.0 / length)) : before_ts, arm.side, tuning);
    if (fresh) {
        memory.bend_ts = wanted_ts;
    } else {
        // A pole nearly parallel to the axis determines no direction, so the filter slows down
        // there.
        const double clear = smooth_step(length / std::max(pole_ts.norm(), 1e-9), 0.0, 0.5);
        memory.bend_ts = turn_bend(
            axis_ts, before_ts, wanted_ts,
            {follow_share(dt_s * clear, tuning.swivel_lag_s), dt_s * tuning.swivel_speed_radps});
    }
    memory.axis_ts = axis_ts;
    memory.hand_ts = hand_rest_ts;
    memory.elbow_ts = circle.middle_ts + circle.radius_m * memory.bend_ts;
    out.shoulder_ps = arm.rest_ps + from_facing(facing, shoulder_ts);
    out.bend_ps = from_facing(facing, memory.bend_ts);
    out.stretch = stretch;
}

void estimate_once(const Player& player, const Step& step, bool reset, ArmMemory& memory,
                   ArmEstimate& out) {
    const ArmTuning& tuning = step.tuning;
    const double dt_s = step.dt_s;
    const double arm_m = player.measures.upper_arm_m + player.measures.forearm_m;
    const Vec3 eye_ps = player.head_ps.position;
    const Mat3 head_axes = player.head_ps.rotation.toRotationMatrix();
    const Vec3 up_ps = head_axes.col(1);
    const Vec3 look_ps = level_look(-head_axes.col(2), up_ps);
    memory.look_ps = reset ? look_ps : follow_look(memory.look_ps, look_ps, step.look_share);
    std::array<Mat3, k_hand_count> hand_axes;
    std::array<HandReach, k_hand_count> reach;
    const double arms = 1.0 / arm_m;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const Pose& hand_ps = player.hands_ps[side];
        hand_axes[side] = hand_ps.rotation.toRotationMatrix();
        reach[side] = {(hand_ps.position - eye_ps) * arms, hand_axes[side].col(1)};
    }
    const Quat lean = chest_lean(up_ps, tuning.lean);
    const Vec3 facing_ps =
        chest_facing(memory.look_ps, lean, reach, {step.limit_sine, step.limit_cosine}, tuning);
    memory.facing_ps =
        reset ? facing_ps
              : turn_at_most(memory.facing_ps, facing_ps, dt_s * tuning.chest_speed_radps);
    out.facing_ps = memory.facing_ps;
    out.chest_ps.rotation = product(lean, level_rotation(out.facing_ps));
    const Mat3 chest_axes = out.chest_ps.rotation.toRotationMatrix();
    const double scale = player.measures.eye_height_m / k_scale_eye_m;
    out.chest_ps.position =
        eye_ps + scale * (chest_axes * tuning.shoulder_offset_m - tuning.neck_m * up_ps);
    const Vec3 right_ps = (0.5 * player.measures.shoulder_width_m) * chest_axes.col(0);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t i = index_of(side);
        const double outward = side == HandSide::left ? -1.0 : 1.0;
        estimate_arm(
            step,
            {side, reset, player.measures.upper_arm_m, arm_m, out.facing_ps,
             out.chest_ps.position + outward * right_ps, player.hands_ps[i].position, hand_axes[i]},
            memory.arms[i], out.arms[i]);
    }
}

Pose between(const Pose& a, const Pose& b, double share) {
    const double sign = a.rotation.dot(b.rotation) < 0.0 ? -share : share;
    const Quat::Coefficients mixed =
        (1.0 - share) * a.rotation.coeffs() + sign * b.rotation.coeffs();
    return {a.position + share * (b.position - a.position),
            unit_quat(mixed[3], mixed[0], mixed[1], mixed[2])};
}

// Divides frames much longer than k_step_s into steps, with head and hands interpolated linearly.
// The state then evolves nearly equally at any frame rate down to 10 Hz. k_round_up keeps the frame
// lengths at which the number of steps changes away from usual frame rates.
void estimate_player(const Player& now, const Step& frame, ArmMemory& memory, ArmEstimate& out) {
    constexpr double k_step_s = 1.0 / 90.0;
    constexpr double k_max_steps = 9.0;
    constexpr double k_round_up = 0.3;
    const double dt_s = frame.dt_s;
    const bool reset =
        !memory.known || has_jumped(memory.head_ps.position, now.head_ps.position, dt_s);
    const int steps =
        reset ? 1 : static_cast<int>(std::clamp(dt_s / k_step_s + k_round_up, 1.0, k_max_steps));
    if (steps > 1) {
        Player before{
            memory.head_ps, {memory.arms[0].hand_ps, memory.arms[1].hand_ps}, now.measures};
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            if (has_jumped(before.hands_ps[side].position, now.hands_ps[side].position, dt_s)) {
                before.hands_ps[side] = now.hands_ps[side];
            }
        }
        const Step step = step_of(dt_s / steps, frame.tuning);
        for (int i = 1; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            const Player then{between(before.head_ps, now.head_ps, share),
                              {between(before.hands_ps[0], now.hands_ps[0], share),
                               between(before.hands_ps[1], now.hands_ps[1], share)},
                              now.measures};
            estimate_once(then, step, false, memory, out);
        }
        estimate_once(now, step, false, memory, out);
    } else {
        estimate_once(now, frame, reset, memory, out);
    }
    memory.known = true;
    memory.head_ps = now.head_ps;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        memory.arms[side].hand_ps = now.hands_ps[side];
    }
}

// Writes the palms' poses to the estimates, in play space.
void take_hands(const EstimateArmsIo& io) {
    Entity player = k_no_entity;
    const Pose* origin_ws = nullptr;
    ArmEstimate* estimate = nullptr;
    for (std::size_t row = 0; row < io.owner.size(); ++row) {
        const HandOwner& owner = io.owner.rows()[row];
        if (owner.player != player) {  // a player's hands are usually in adjacent rows
            player = owner.player;
            origin_ws = &io.origin.at(player).pose_ws;
            estimate = &io.estimate.at(player);
        }
        const Pose& palm_ws = io.palm.at(io.owner.owners()[row]).pose_ws;
        const Quat turn = product(origin_ws->rotation.conjugate(), palm_ws.rotation);
        estimate->arms[index_of(owner.side)].hand_ps = {
            inverse_transform_point(*origin_ws, palm_ws.position),
            unit_quat(turn.w(), turn.x(), turn.y(), turn.z())};
    }
}

}  // namespace

Vec3 level_look(const Vec3& ahead, const Vec3& up) {
    // Blends from 45 degrees of pitch to 90; ahead.y() is the sine of the pitch.
    const double pitch = ahead.y();
    const double blend = smooth_step(std::abs(pitch), 0.70710678118654752, 1.0);
    const Vec3 look = (1.0 - blend) * ahead + (pitch > 0.0 ? -blend : blend) * up;
    const double length = std::sqrt(look.x() * look.x() + look.z() * look.z());
    return length > 1e-9 ? Vec3(look.x() / length, 0.0, look.z() / length) : Vec3(-Vec3::UnitZ());
}

Vec3 follow_look(const Vec3& look_ps, const Vec3& now_ps, double share) {
    const double cosine_now = look_ps.dot(now_ps);
    if (cosine_now > k_near_cosine) {
        return level_unit(look_ps + share_of_line(share, cosine_now) * (now_ps - look_ps));
    }
    const double angle = arc_tangent2(cross_y(look_ps, now_ps), cosine_now);
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle * share, sine, cosine);
    return level_unit(turn_level(look_ps, cosine, sine));
}

Vec3 turn_at_most(const Vec3& facing_ps, const Vec3& now_ps, double most_rad) {
    const double sine_now = cross_y(facing_ps, now_ps);
    const double cosine_now = facing_ps.dot(now_ps);
    // In most frames the angle is below the limit. sin x > 0.9 x for x < 0.7 shows this without
    // trigonometry.
    if (cosine_now > 0.75 && std::abs(sine_now) <= 0.9 * most_rad) {
        return now_ps;
    }
    const double angle = arc_tangent2(sine_now, cosine_now);
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(std::clamp(angle, -most_rad, most_rad), sine, cosine);
    return level_unit(turn_level(facing_ps, cosine, sine));
}

Quat chest_lean(const Vec3& head_up_ps, double share) {
    const Vec3 up = (1.0 - share) * Vec3::UnitY() + share * head_up_ps;
    const double length = up.norm();
    return length > 0.1 ? rotation_between(Vec3::UnitY(), up / length) : Quat::Identity();
}

Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps,
                  const std::array<HandReach, k_hand_count>& hands_ps, const TurnLimit& limit,
                  const ArmTuning& tuning) {
    // Hands in the leaning chest's axes, turned to the look direction: x right, z back.
    const Mat3 lean = lean_ps.toRotationMatrix();
    std::array<Vec3, k_hand_count> hand;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        hand[side] = to_facing(look_ps, lean.transpose() * hands_ps[side].position);
        if (tuning.behind_fade > 0.0) {
            hand[side] *= 1.0 - tuning.behind_fade * smooth_step(hand[side].z(), 0.0, 0.4);
        }
    }
    const Vec3 line = hand[1] - hand[0];
    const double rolled = lean.col(1).dot(hands_ps[1].back - hands_ps[0].back);
    const double right = tuning.hand_share * (hand[0].x() + hand[1].x()) +
                         tuning.line_share * line.z() + tuning.roll_share * rolled;
    const double ahead = 1.0 - tuning.hand_share * (hand[0].z() + hand[1].z()) +
                         tuning.line_share * std::max(line.x(), 0.0);
    const double length = std::sqrt(right * right + ahead * ahead);
    double sine = length > 0.0 ? -right / length : 0.0;
    double cosine = length > 0.0 ? ahead / length : 1.0;
    if (cosine < limit.cosine) {
        cosine = limit.cosine;
        sine = std::copysign(limit.sine, sine);
    }
    return level_unit(turn_level(look_ps, cosine, sine));
}

Vec3 clavicle_shift(const Vec3& hand, const ArmTuning& tuning) {
    const double distance = hand.norm();
    const double reach_m = tuning.clavicle_share * clavicle_reach_m(distance);
    return Vec3(0.0, hand.y() + tuning.clavicle_lift, hand.z()) *
           (reach_m / std::max(distance, 0.3));
}

Vec3 shoulder_follow(const Vec3& hand_m, double arm_m, const ArmTuning& tuning) {
    const double distance = hand_m.norm();
    const double beyond = distance - tuning.reach * arm_m;
    return beyond <= 0.0 ? Vec3(Vec3::Zero())
                         : Vec3(hand_m * (std::min(beyond, tuning.shoulder_follow_m) / distance));
}

Vec3 elbow_pole(const Vec3& facing_ps, const Mat3& hand_axes_ps, HandSide side,
                const ArmTuning& tuning) {
    const double out = side == HandSide::right ? 1.0 : -1.0;
    const Vec3 in_hand(-out * tuning.pole_thumb, tuning.pole_back, -tuning.pole_fingers);
    Vec3 pole = to_facing(facing_ps, hand_axes_ps * in_hand) + tuning.pole_rest;
    pole.x() += (out - 1.0) * tuning.pole_rest.x();
    return pole;
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
    if (!(cosine_now > k_near_cosine && std::abs(sine) < 0.98 * turn.most_rad)) {
        const double angle = arc_tangent2(sine_now, cosine_now);
        sin_cos(std::clamp(turn.share * angle, -turn.most_rad, turn.most_rad), sine, cosine);
    }
    const Vec3 turned = cosine * bend_ts + sine * side;
    return turned * (1.0 / turned.norm());
}

void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning) {
    take_hands(io);
    const Step step = step_of(io.dt_s, tuning);
    join(
        io.estimate,
        [&](Entity, ArmEstimate& out, ArmMemory& memory, const HeadTracking& head,
            const BodyMeasures& measures) {
            estimate_player({head.pose_ps, {out.arms[0].hand_ps, out.arms[1].hand_ps}, measures},
                            step, memory, out);
        },
        io.memory, io.head, io.measures);
}

}  // namespace handhold
