#include "systems/body/shared/rest_hand.hpp"

#include <algorithm>
#include <cmath>

#include "components/body_tuning.hpp"
#include "systems/body/shared/level_direction.hpp"

namespace handhold {
namespace {

// Least height of a resting wrist above the tracked floor.
constexpr double k_rest_floor_m = 0.06;
// Least time for the way to the rest pose or back.
constexpr double k_shortest_s = 0.15;
// Greatest slope of smooth_step.
constexpr double k_slope = 1.5;

// Share of the way from `a` to `b` that a frame may advance.
double share_of(const Pose& a, const Pose& b, double scale, double dt_s) {
    const double distance_m = (b.position - a.position).norm() / scale;
    const double cosine = std::min(1.0, std::abs(a.rotation.dot(b.rotation)));
    const double angle_rad = 2.0 * arc_tangent2(std::sqrt(1.0 - cosine * cosine), cosine);
    const double needed_s =
        k_slope * std::max(distance_m / k_rest_speed_mps, angle_rad / k_rest_spin_radps);
    return dt_s / std::max(needed_s, k_shortest_s);
}

}  // namespace

Pose view_frame(const Vec3& eyes_ps, const Vec3& look_ps) {
    return {eyes_ps, level_rotation(look_ps)};
}

Pose rest_hand(HandSide side, const Pose& view_ps, double lying, const TrackedBody& body) {
    // In the level axes of the view, for a right hand: offset from the eyes in arm lengths, and
    // directions of the fingers and out of the back of the hand. The directions are means over the
    // people of body_train's train set. The offset gives the least errors of chest yaw and elbow
    // there, if one hand of each frame is replaced by the rest pose.
    const Vec3 offset = mirrored_if_left(Vec3(0.37, -1.02, -0.25), side);
    const Vec3 fingers = mirrored_if_left(Vec3(0.324, -0.439, -0.838), side);
    const Vec3 back = mirrored_if_left(Vec3(0.794, 0.607, -0.011), side);
    Quat axes = view_ps.rotation;
    if (lying > 0.0) {
        const Vec3 up =
            (1.0 - lying) * Vec3::UnitY() + lying * (body.head_ps.rotation * Vec3::UnitY());
        const double length = up.norm();
        if (length > 0.1) {
            axes = (rotation_between(Vec3::UnitY(), up / length) * axes).normalized();
        }
    }
    Pose rest{view_ps.position + arm_length_m(body.measures) * (axes * offset),
              (axes * look_rotation(fingers, back)).normalized()};
    const double scale = body.measures.eye_height_m / k_scale_eye_m;
    rest.position.y() = std::max(rest.position.y(), body.floor_m + scale * k_rest_floor_m);
    return rest;
}

ArmGoal arm_goal(const Grab& grab, const HandTracking& tracking) {
    if (grab.kind != GripKind::none) {
        return ArmGoal::grip;
    }
    const bool is_shown =
        tracking.state == TrackingState::tracked || tracking.state == TrackingState::inferred;
    return is_shown ? ArmGoal::hand : ArmGoal::rest;
}

void start_hand(ArmGoal goal, HandRest& rest) {
    rest = {};
    rest.is_away = goal == ArmGoal::rest;
    rest.share = rest.is_away ? 1.0 : 0.0;
}

Pose place_hand(const GivenHand& given, double scale, double dt_s, HandRest& rest) {
    const bool is_away = given.goal == ArmGoal::rest;
    if (given.goal == ArmGoal::grip || (!is_away && !rest.is_away && rest.share == 0.0)) {
        rest = {};
        return given.hand_ps;
    }
    if (is_away != rest.is_away) {
        rest.is_away = is_away;
        rest.from_vs = inverse(given.view_before_ps) * given.before_ps;
        rest.share = is_away ? 0.0 : 1.0;
    }
    const Pose from_ps = given.view_ps * rest.from_vs;
    const Pose& to_ps = is_away ? given.rest_ps : given.hand_ps;
    const double step = share_of(from_ps, to_ps, scale, dt_s);
    rest.share = is_away ? std::min(1.0, rest.share + step) : std::max(0.0, rest.share - step);
    if (rest.share == (is_away ? 1.0 : 0.0)) {
        rest.from_vs = {};
        return to_ps;
    }
    const double passed = is_away ? rest.share : 1.0 - rest.share;
    return interpolate(from_ps, to_ps, smooth_step(passed, 0.0, 1.0));
}

Vec3 within_reach(const Vec3& hand_ps, const Vec3& shoulder_ps, double most_m) {
    const Vec3 line = hand_ps - shoulder_ps;
    const double distance = line.norm();
    return distance > most_m ? Vec3(shoulder_ps + (most_m / distance) * line) : hand_ps;
}

}  // namespace handhold
