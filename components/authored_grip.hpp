#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "components/hand_rig.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Authored grips: hand poses made beforehand for objects that are held in one particular way, such
// as a gun by its handle. Talk row 10.
namespace handhold {

inline constexpr std::size_t k_max_authored_grips = 4;  // maximum per body

// Pose of one hand in a grip.
struct AuthoredHand {
    bool is_there = false;  // false: the grip has no pose for this hand
    Pose wrist_bs;          // wrist in the body's frame
    // Indexed by FingerName. False: the finger has no authored pose and closes on the surface.
    std::array<bool, k_finger_count> is_posed = {};
    std::array<FingerAngles, k_finger_count> fingers;
    // Indexed by FingerName. True: the posed finger moves from `fingers` to `pressed` as far as the
    // controller's trigger is pressed.
    std::array<bool, k_finger_count> follows_trigger = {};
    std::array<FingerAngles, k_finger_count> pressed;
};

struct AuthoredGrip {
    std::array<AuthoredHand, k_hand_count> hands;  // indexed by HandSide
    // A hand that closes inside several snap zones takes the grip with the highest priority.
    std::int32_t priority = 0;
    // Snap zone: maximum distance and rotation of the closing hand's palm from its authored pose.
    double snap_radius_m = 0.08;
    double snap_angle_rad = 1.0471975511965976;
};

// Authored grips of one body. Created with the body; constant while frames run.
struct AuthoredGrips {
    std::array<AuthoredGrip, k_max_authored_grips> grips;
    std::uint8_t count = 0;
};

// The authored grip that a hand currently uses. Only hands in an authored grip have this component.
// It applies only while the hand's Grab is on `body`. Written by update_grabs; change_shape moves
// hand.wrist_bs to the body's new frame, and teleports remove it. Read by anchor_grabs,
// gather_surroundings and publish_pose.
struct AuthoredHold {
    Entity body = k_no_entity;
    std::uint8_t grip = 0;  // index into AuthoredGrips::grips
    AuthoredHand hand;      // copy of the pose for this hand's side
    // Maximum rotation of a hand that may turn in its grip; beyond it the hand leaves the grip.
    double leave_angle_rad = 0.0;
};

}  // namespace handhold
