#include "game/devices/headset_hands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "game/devices/controller_profile.hpp"

namespace handhold {
namespace {

constexpr double k_closes = 0.55;
constexpr double k_opens = 0.35;
constexpr double k_dead_stick = 0.18;
constexpr double k_snap_stick = 0.7;

double past_dead_zone(double value) {
    const double size =
        std::clamp((std::abs(value) - k_dead_stick) / (1.0 - k_dead_stick), 0.0, 1.0);
    return std::copysign(size, value);
}

std::optional<hh::Pose> hand_pose(const HandPoses& hand, hh::Side side, hh::Vec3 palm_center_m,
                                  const std::array<hh::Pose, 2>* own_joints) {
    if (own_joints != nullptr && hand.grip_ps) {
        return *hand.grip_ps * (*own_joints)[side];
    }
    if (hand.palm_ps) {
        return *hand.palm_ps * hand_in_palm(side, palm_center_m);
    }
    if (hand.grip_ps) {
        return *hand.grip_ps * hand_in_grip(side, palm_center_m);
    }
    return hand.wrist_ps;
}

// A finger that is not seen stays as it was last.
void remember_curls(const hh_finger_curls& curls, hh_finger_curls& last) {
    for (std::size_t f = 0; f < std::size(last.fingers); ++f) {
        last.fingers[f] = curls.fingers[f] >= 0.0 ? curls.fingers[f] : last.fingers[f];
    }
}

}  // namespace

hh::Pose hand_in_grip(hh::Side side, hh::Vec3 palm_center_m) {
    return hh::inverse(handle_in_hand(side, HandleGrip{}, palm_center_m));
}

hh::Pose hand_in_palm(hh::Side side, hh::Vec3 palm_center_m) {
    const double outward = side == HH_RIGHT ? 1.0 : -1.0;
    const hh::Quat rotation = hh::rotation_about(hh::k_z, -0.5 * std::numbers::pi * outward);
    palm_center_m.x *= outward;
    return {-(rotation * palm_center_m), rotation};
}

double finger_curl(const hh::Vec3& wrist, const hh::Vec3& knuckle, const hh::Vec3& tip) {
    const hh::Vec3 hand = knuckle - wrist;
    const hh::Vec3 finger = tip - knuckle;
    const double lengths = hh::length(hand) * hh::length(finger);
    const double cosine = hh::dot(hand, finger) / lengths;
    constexpr double k_longest = 4.0;  // longest finger, in distances of knuckle and wrist
    if (!std::isfinite(cosine) || hh::length(finger) > k_longest * hh::length(hand)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return std::clamp(0.5 * (1.0 - cosine), 0.0, 1.0);
}

hh::Sample read_headset(const HeadsetReading& reading, double t_s, const HandShape& shape,
                        HeadsetMemory& memory, const std::array<hh::Pose, 2>* own_joints) {
    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head_tracked = reading.head_ps.has_value();
    sample.head = reading.head_ps.value_or(hh::k_origin);
    sample.head_inferred = reading.is_head_inferred;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const HandReading& hand = reading.hands[side];
        const HandPoses measured{hand.grip_ps, hand.palm_ps, hand.wrist_ps};
        const auto hand_ps = hand_pose(measured, side, shape.palm_center_m, own_joints);
        const hh::Pose& joint =
            own_joints != nullptr ? (*own_joints)[side] : shape.in_controller[side];
        sample.hand_tracked[side] = hand_ps.has_value();
        if (hand_ps) {
            double& curl = memory.curls[side];
            if (hand.grip_ps || hand.palm_ps) {
                curl = 0.0;  // fingers lie about a controller all the time
                memory.fingers[side] = k_curls_unknown;
            } else {
                curl = std::isnan(hand.curl) ? curl : hand.curl;
                remember_curls(hand.curls, memory.fingers[side]);
            }
            const double closes = std::max({hand.squeeze, hand.trigger, curl});
            memory.grabs[side] = closes > (memory.grabs[side] ? k_opens : k_closes);
            sample.squeeze[side] = closes;
            sample.trigger[side] = hand.trigger;
            sample.hands[side] = *hand_ps * hh::inverse(joint);
        } else if (const auto guess_ps =
                       hand_pose(hand.guesses, side, shape.palm_center_m, own_joints)) {
            sample.hand_inferred[side] = true;
            sample.hands[side] = *guess_ps * hh::inverse(joint);
        }
        sample.curls[side] = memory.fingers[side];
        sample.grab[side] = memory.grabs[side];
    }
    return sample;
}

hh_commands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                  HeadsetMemory& memory) {
    const HandReading& left = reading.hands[HH_LEFT];
    const HandReading& right = reading.hands[HH_RIGHT];
    hh_commands commands{};
    const double to_left = -past_dead_zone(right.stick[0]);
    if (turn == TurnKind::smooth) {
        commands.smooth_turn = to_left;
    } else if (std::abs(right.stick[0]) > k_snap_stick) {
        commands.snap_turns = memory.turned ? 0 : (to_left > 0.0 ? 1 : -1);
        memory.turned = true;
    } else if (to_left == 0.0) {
        memory.turned = false;
    }
    commands.brake = left.brake || right.brake ? 1.0 : 0.0;
    commands.calibrate = left.calibrate && right.calibrate;
    if (reading.head_ps) {
        commands.thrust = reading.head_ps->rotation * hh::Vec3{past_dead_zone(left.stick[0]), 0.0,
                                                               -past_dead_zone(left.stick[1])};
    }
    return commands;
}

}  // namespace handhold
