#include "game/devices/headset_hands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "game/devices/controller_profile.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold {
namespace {

constexpr double k_closes = 0.55;
constexpr double k_opens = 0.35;
constexpr double k_dead_stick = 0.18;
constexpr double k_snap_stick = 0.7;

Pose not_tracked() {
    Pose pose;
    pose.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
}

double past_dead_zone(double value) {
    const double size =
        std::clamp((std::abs(value) - k_dead_stick) / (1.0 - k_dead_stick), 0.0, 1.0);
    return std::copysign(size, value);
}

std::optional<Pose> hand_pose(const HandReading& hand, HandSide side, const HandTuning& tuning,
                              const std::array<Pose, k_hand_count>* own_joints) {
    if (own_joints != nullptr && hand.grip_ps) {
        return *hand.grip_ps * (*own_joints)[index_of(side)];
    }
    if (hand.palm_ps) {
        return *hand.palm_ps * hand_in_palm(side, tuning);
    }
    if (hand.grip_ps) {
        return *hand.grip_ps * hand_in_grip(side, tuning);
    }
    return hand.wrist_ps;
}

}  // namespace

Pose hand_in_grip(HandSide side, const HandTuning& tuning) {
    return inverse(handle_in_hand(side, HandleGrip{}, tuning));
}

Pose hand_in_palm(HandSide side, const HandTuning& tuning) {
    const double outward = side == HandSide::right ? 1.0 : -1.0;
    const Quat rotation = rotation_about(Vec3::UnitZ(), -k_half_pi * outward);
    Vec3 palm = tuning.palm_center_m;
    palm.x() *= outward;
    return {-(rotation * palm), rotation};
}

double finger_curl(const Vec3& wrist, const Vec3& knuckle, const Vec3& tip) {
    const Vec3 hand = knuckle - wrist;
    const Vec3 finger = tip - knuckle;
    const double lengths = hand.norm() * finger.norm();
    const double cosine = hand.dot(finger) / lengths;
    constexpr double k_longest = 4.0;  // longest finger, in distances of knuckle and wrist
    if (!std::isfinite(cosine) || finger.norm() > k_longest * hand.norm()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return std::clamp(0.5 * (1.0 - cosine), 0.0, 1.0);
}

TrackingSample read_headset(const HeadsetReading& reading, double t_s, const HandTuning& tuning,
                            HeadsetMemory& memory,
                            const std::array<Pose, k_hand_count>* own_joints) {
    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps = reading.head_ps.value_or(not_tracked());
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const auto side = static_cast<HandSide>(i);
        const HandReading& hand = reading.hands[i];
        ControllerSample& controller = sample.controllers[i];
        if (const std::optional<Pose> hand_ps = hand_pose(hand, side, tuning, own_joints)) {
            double& curl = memory.curls[i];
            if (hand.grip_ps || hand.palm_ps) {
                curl = 0.0;  // fingers lie about a controller all the time
            } else if (!std::isnan(hand.curl)) {
                curl = hand.curl;
            }
            const double closes = std::max({hand.squeeze, hand.trigger, curl});
            memory.grabs[i] = closes > (memory.grabs[i] ? k_opens : k_closes);
            controller.squeeze = closes;
            controller.trigger = hand.trigger;
            const Pose joint =
                own_joints != nullptr ? (*own_joints)[i] : default_controller_to_hand(side, tuning);
            controller.controller_ps = *hand_ps * inverse(joint);
        } else {
            controller.controller_ps = not_tracked();
        }
        controller.grab = memory.grabs[i];
    }
    return sample;
}

PlayerCommands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                     HeadsetMemory& memory) {
    const HandReading& left = reading.hands[index_of(HandSide::left)];
    const HandReading& right = reading.hands[index_of(HandSide::right)];
    PlayerCommands commands;
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
        commands.thrust_ps = reading.head_ps->rotation * Vec3(past_dead_zone(left.stick[0]), 0.0,
                                                              -past_dead_zone(left.stick[1]));
    }
    return commands;
}

}  // namespace handhold
