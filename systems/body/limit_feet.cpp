#include "systems/body/limit_feet.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/two_bone_ik.hpp"
#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/fold_body.hpp"

namespace handhold {
namespace {

// Share of the change of velocity in a frame with which a lagging foot brakes as its leg becomes
// straight.
constexpr double k_brake_share = 0.6;
// Distance between knees and between ankles, along the pelvis, in distances between the hips.
constexpr double k_legs_apart = 0.75;
// Least share of the leg's length between hip and ankle that a lagging foot may take.
constexpr double k_shortest_leg = 0.01;

// The hip relative to the chest, and the longest distance from there to the ankle.
struct Reach {
    Vec3 hip_m;    // position at the frame's end
    Vec3 hip_mps;  // velocity in this frame
    double leg_m = 0.0;
};

// Slows a foot that moves away from its hip, so that it does not stop dead when the leg is
// straight.
// `step_mps`: how much the velocity may change in this frame. If each frame brakes by b, a foot at
// the distance d from its end may move by v = sqrt(b^2 + 2 b d / dt) - b.
Vec3 braked(const Vec3& velocity_mps, double step_mps, double dt_s, const Reach& reach,
            const ShownJoint& foot) {
    const Vec3 from_hip = foot.shown_m - (reach.hip_m - dt_s * reach.hip_mps);
    const double distance_m = from_hip.norm();
    const double room_m = std::max(0.0, reach.leg_m - distance_m);
    const double outward_mps =
        (velocity_mps - reach.hip_mps).dot(from_hip) / std::max(distance_m, 1e-9);
    const double brake_mps = k_brake_share * step_mps;
    const double most_mps = std::sqrt(brake_mps * (brake_mps + 2.0 * room_m / dt_s)) - brake_mps;
    return outward_mps > most_mps
               ? Vec3(velocity_mps +
                      ((most_mps - outward_mps) / std::max(distance_m, 1e-9)) * from_hip)
               : velocity_mps;
}

// Where the foot is shown, relative to the chest. `wanted_m`: where the leg puts it.
Vec3 limited(const Vec3& wanted_m, const Reach& reach, double scale, double dt_s,
             const ShownJoint& foot) {
    const Vec3 next_mps = limited_mps(wanted_m, k_foot_limits, scale, dt_s, foot);
    const Vec3 next_m = shown_at(wanted_m, next_mps, dt_s, foot);
    if (next_m == wanted_m) {
        return wanted_m;
    }
    const double step_mps = step_mps_of(k_foot_limits, scale, dt_s);
    const Vec3 change_mps = braked(next_mps, step_mps, dt_s, reach, foot) - foot.velocity_mps;
    return foot.shown_m + dt_s * (foot.velocity_mps + shortened_to(change_mps, step_mps));
}

// Distance between hip and ankle of a leg whose knee is bent least.
double longest_m(double thigh_m, double shin_m) {
    static const double k_cosine = [] {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(k_least_knee_rad, sine, cosine);
        return cosine;
    }();
    return std::sqrt(thigh_m * thigh_m + shin_m * shin_m + 2.0 * thigh_m * shin_m * k_cosine);
}

Quat turned(const Vec3& from, const Vec3& to, const Quat& rotation) {
    return (rotation_between(from.normalized(), to.normalized()) * rotation).normalized();
}

// Moves the ankle to `ankle_ws`, or as near as the bones reach. Returns its place.
Vec3 move_ankle(const Vec3& ankle_ws, SpinePose::Leg& leg) {
    const Vec3 hip = leg.thigh_ws.position;
    const Vec3 thigh = leg.shin_ws.position - hip;
    const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
    const double thigh_m = thigh.norm();
    const double shin_m = shin.norm();
    const Vec3 line = ankle_ws - hip;
    const double length_m = line.norm();
    if (!(length_m > 1e-6 && thigh_m > 1e-6 && shin_m > 1e-6)) {
        return leg.foot_ws.position;
    }
    const Vec3 axis = line * (1.0 / length_m);
    const double shortest_m =
        std::max(std::abs(thigh_m - shin_m), k_shortest_leg * (thigh_m + shin_m));
    const double reach_m = std::clamp(length_m, shortest_m, longest_m(thigh_m, shin_m));
    const MiddleJoint knee = middle_joint(reach_m, thigh_m, shin_m);
    // A straight leg bends forwards.
    Vec3 aside = thigh - axis * axis.dot(thigh);
    if (aside.norm() < 1e-3 * thigh_m) {
        const Vec3 ahead = leg.thigh_ws.rotation * -Vec3::UnitZ();
        aside = ahead - axis * axis.dot(ahead);
    }
    const double aside_m = aside.norm();
    const Vec3 knee_ws =
        hip + knee.along_m * axis +
        (aside_m > 1e-9 ? Vec3(aside * (knee.aside_m / aside_m)) : Vec3(Vec3::Zero()));
    const Vec3 end_ws = hip + reach_m * axis;
    const Quat in_shin = leg.shin_ws.rotation.conjugate() * leg.foot_ws.rotation;
    leg.thigh_ws.rotation = turned(thigh, knee_ws - hip, leg.thigh_ws.rotation);
    leg.shin_ws = {knee_ws, turned(shin, end_ws - knee_ws, leg.shin_ws.rotation)};
    leg.foot_ws = {end_ws, (leg.shin_ws.rotation * in_shin).normalized()};
    return leg.foot_ws.position;
}

// Turns a leg about its hip.
void turn_leg(const Quat& turn, SpinePose::Leg& leg) {
    const Vec3 hip = leg.thigh_ws.position;
    for (Pose* const bone : {&leg.thigh_ws, &leg.shin_ws, &leg.foot_ws}) {
        *bone = {hip + turn * (bone->position - hip), (turn * bone->rotation).normalized()};
    }
}

// Legs do not cross: turns both away from each other until the right knee and ankle are to the
// right of the left ones. `apart_m`: how far.
void part_legs(double apart_m, SpinePose& pose) {
    const Vec3 right = pose.pelvis_ws.rotation * Vec3::UnitX();
    for (const auto joint : {&SpinePose::Leg::shin_ws, &SpinePose::Leg::foot_ws}) {
        const Vec3 between = (pose.legs[1].*joint).position - (pose.legs[0].*joint).position;
        const double missing_m = apart_m - right.dot(between);
        if (missing_m <= 0.0) {
            continue;
        }
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            SpinePose::Leg& leg = pose.legs[side];
            const Vec3 line = (leg.*joint).position - leg.thigh_ws.position;
            const double length_m = line.norm();
            const Vec3 axis = line.cross(side == 0 ? Vec3(-right) : right);
            const double square = axis.norm() / std::max(length_m, 1e-9);
            if (square > 0.1) {
                const double turn_rad = std::min(0.5 * missing_m / (length_m * square), 1.0);
                turn_leg(rotation_about(axis.normalized(), turn_rad), leg);
            }
        }
    }
}

void limit_feet_of(const LimitFeetIo& io, std::size_t index) {
    const Entity player = io.pose.owners()[index];
    SpinePose& pose = io.pose.elements()[index];
    SpineMemory& memory = io.memory.at(player);
    const auto& [origin_ws, scale] = io.origin.at(player);
    part_legs(
        k_legs_apart * (pose.legs[1].thigh_ws.position - pose.legs[0].thigh_ws.position).norm(),
        pose);
    const Mat3 to_ps = origin_ws.rotation.toRotationMatrix().transpose();
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        SpinePose::Leg& leg = pose.legs[side];
        ShownJoint& foot = memory.feet[side];
        const Vec3& chest_ws = pose.chest_ws.position;
        const Vec3 wanted_m = to_ps * (leg.foot_ws.position - chest_ws);
        const Vec3 hip_m = to_ps * (leg.thigh_ws.position - chest_ws);
        const Vec3 hip_mps = (hip_m - memory.hips_m[side]) / io.dt_s;
        memory.hips_m[side] = hip_m;
        if (!foot.known) {
            foot = {true, wanted_m, wanted_m, Vec3::Zero()};
            continue;
        }
        const Reach reach{hip_m, hip_mps,
                          longest_m((leg.shin_ws.position - leg.thigh_ws.position).norm(),
                                    (leg.foot_ws.position - leg.shin_ws.position).norm())};
        Vec3 shown_m = limited(wanted_m, reach, scale, io.dt_s, foot);
        if (shown_m != wanted_m) {
            const Vec3 ankle_ws = move_ankle(chest_ws + to_ps.transpose() * shown_m, leg);
            shown_m = to_ps * (ankle_ws - chest_ws);
        }
        foot = {true, wanted_m, shown_m, (shown_m - foot.shown_m) / io.dt_s};
    }
}

}  // namespace

void limit_feet(const LimitFeetIo& io) {
    constexpr std::size_t k_players_per_slice = 32;
    parallel_each(io.pose.size(), k_players_per_slice,
                  [&io](std::size_t index) { limit_feet_of(io, index); });
}

}  // namespace handhold
