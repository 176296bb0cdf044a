#include "tools/lab/body_looks.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/scalar_rotation.hpp"

namespace handhold::lab {
namespace {

struct Line {
    Vec3 from;
    Vec3 to;
};

double angle_rad(const Vec3& a, const Vec3& b) { return arc_tangent2(a.cross(b).norm(), a.dot(b)); }

double distance_m(const Vec3& point, const Line& line) {
    const Vec3 along = line.to - line.from;
    const double share = along.dot(point - line.from) / std::max(along.squaredNorm(), 1e-12);
    return (line.from + std::clamp(share, 0.0, 1.0) * along - point).norm();
}

// Exact within a twentieth of a bone: the distance from points of one line to the other.
double distance_m(const Line& a, const Line& b) {
    constexpr int k_points = 21;
    double least_m = distance_m(a.from, b);
    for (int i = 1; i < k_points; ++i) {
        const double share = static_cast<double>(i) / (k_points - 1);
        least_m = std::min(least_m, distance_m(a.from + share * (a.to - a.from), b));
    }
    return least_m;
}

std::array<Line, 2> bones_of(const SpinePose::Leg& leg) {
    return {{{leg.thigh_ws.position, leg.shin_ws.position},
             {leg.shin_ws.position, leg.foot_ws.position}}};
}

double between_legs_m(const SpinePose& spine) {
    double least_m = 1e9;
    for (const Line& left : bones_of(spine.legs[0])) {
        for (const Line& right : bones_of(spine.legs[1])) {
            least_m = std::min(least_m, distance_m(left, right));
        }
    }
    return least_m;
}

// Whether elbow and forearm are inside the trunk, and the wrist bent, with the elbow at a place.
struct ArmLook {
    bool elbow, forearm, wrist;
};

template <typename InTrunk>
ArmLook look_of(const Vec3& elbow, const ArmPose::Arm& arm, const InTrunk& in_trunk) {
    const Vec3 forearm = arm.hand_ws.position - elbow;
    ArmLook look{};
    look.elbow = in_trunk(elbow);
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        look.forearm = look.forearm || in_trunk(elbow + share * forearm);
    }
    look.wrist = angle_rad(forearm, arm.hand_ws.rotation * -Vec3::UnitZ()) > k_bent_wrist_rad;
    return look;
}

// For each look whether the arm has it at every turn of the elbow about the line from shoulder to
// hand.
template <typename InTrunk>
ArmLook unavoidable(const ArmPose::Arm& arm, const InTrunk& in_trunk) {
    constexpr int k_turns = 72;
    const Vec3& shoulder = arm.upper_ws.position;
    const Vec3 line = arm.hand_ws.position - shoulder;
    ArmLook all = look_of(arm.forearm_ws.position, arm, in_trunk);
    if (line.norm() < 1e-6) {
        return all;
    }
    for (int i = 1; i < k_turns; ++i) {
        const Quat turn = rotation_about(line.normalized(), i * 2.0 * k_pi / k_turns);
        const ArmLook look =
            look_of(shoulder + turn * (arm.forearm_ws.position - shoulder), arm, in_trunk);
        all = {all.elbow && look.elbow, all.forearm && look.forearm, all.wrist && look.wrist};
    }
    return all;
}

}  // namespace

void BodyLooks::take(const SpinePose& spine, const ArmPose& arms, double scale, const Quat& to_ps,
                     double dt_s) {
    const Vec3& chest = spine.chest_ws.position;
    const Vec3& hips = spine.pelvis_ws.position;
    const Vec3& waist = spine.spine_ws.back().position;
    const Vec3 up = chest - hips;
    const auto in_trunk = [&](const Vec3& point) {
        return std::min(distance_m(point, {chest, waist}), distance_m(point, {waist, hips})) <
               scale * k_inside_trunk_m;
    };
    Frame frame{};
    frame.crossed = between_legs_m(spine) < scale * k_crossed_legs_m;
    for (const SpinePose::Leg& leg : spine.legs) {
        const Vec3& knee = leg.shin_ws.position;
        const Vec3& ankle = leg.foot_ws.position;
        frame.straight = frame.straight || angle_rad(knee - leg.thigh_ws.position, ankle - knee) <
                                               k_straight_knee_rad;
        frame.high = frame.high || up.dot(ankle - chest) > 0.0;
        for (const ArmPose::Arm& arm : arms.arms) {
            frame.ball =
                frame.ball || (knee - arm.upper_ws.position).norm() < scale * k_knee_at_shoulder_m;
        }
    }
    for (const ArmPose::Arm& arm : arms.arms) {
        const ArmLook look = look_of(arm.forearm_ws.position, arm, in_trunk);
        frame.elbow = frame.elbow || look.elbow;
        frame.forearm = frame.forearm || look.forearm;
        frame.wrist = frame.wrist || look.wrist;
        frame.hand = frame.hand || in_trunk(arm.hand_ws.position);
        if (look.elbow || look.forearm || look.wrist) {
            const ArmLook forced = unavoidable(arm, in_trunk);
            frame.avoidable_elbow = frame.avoidable_elbow || (look.elbow && !forced.elbow);
            frame.avoidable_forearm = frame.avoidable_forearm || (look.forearm && !forced.forearm);
            frame.avoidable_wrist = frame.avoidable_wrist || (look.wrist && !forced.wrist);
        }
    }
    frames_.push_back(frame);
    take_feet(spine, to_ps, dt_s);
}

void BodyLooks::take_feet(const SpinePose& spine, const Quat& to_ps, double dt_s) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const Vec3 foot_m = to_ps * (spine.legs[side].foot_ws.position - spine.chest_ws.position);
        Before& before = before_[side];
        const Vec3 mps = (foot_m - before.foot_m) / dt_s;
        if (before.known) {
            foot_mps_.add(mps.norm());
        }
        if (before.mps) {
            foot_step_mps_.add((mps - *before.mps).norm());
        }
        before = {true, foot_m, before.known ? std::optional(mps) : std::nullopt};
    }
}

nlohmann::ordered_json BodyLooks::json() const {
    const auto percent = [&](bool Frame::*look) {
        const auto count = std::count_if(frames_.begin(), frames_.end(),
                                         [&](const Frame& frame) { return frame.*look; });
        return 100.0 * static_cast<double>(count) /
               static_cast<double>(std::max<std::size_t>(frames_.size(), 1));
    };
    return {{"frames", frames_.size()},
            {"straight_legs_pct", percent(&Frame::straight)},
            {"crossed_legs_pct", percent(&Frame::crossed)},
            {"feet_above_chest_pct", percent(&Frame::high)},
            {"knees_at_shoulders_pct", percent(&Frame::ball)},
            {"elbows_in_trunk_pct", percent(&Frame::elbow)},
            {"forearms_in_trunk_pct", percent(&Frame::forearm)},
            {"bent_wrists_pct", percent(&Frame::wrist)},
            {"hands_in_trunk_pct", percent(&Frame::hand)},
            {"avoidable_elbows_pct", percent(&Frame::avoidable_elbow)},
            {"avoidable_forearms_pct", percent(&Frame::avoidable_forearm)},
            {"avoidable_wrists_pct", percent(&Frame::avoidable_wrist)},
            {"foot_mps_max", foot_mps_.max()},
            {"foot_step_mps_max", foot_step_mps_.max()}};
}

}  // namespace handhold::lab
