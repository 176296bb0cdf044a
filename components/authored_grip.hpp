#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "components/hand_rig.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Grips that somebody posed beforehand, for things that are held in one way: a gun by its handle.
// Talk row 10.
namespace handhold {

inline constexpr std::size_t k_max_authored_grips = 4;  // of one body

// How one hand sits in a grip.
struct AuthoredHand {
    bool is_there = false;  // false: the grip is not for this hand
    Pose wrist_bs;          // in the body's frame
    // By FingerName. Fingers that are not posed close on the surface as on any other.
    std::array<bool, k_finger_count> is_posed = {};
    std::array<FingerAngles, k_finger_count> fingers;
};

struct AuthoredGrip {
    std::array<AuthoredHand, k_hand_count> hands;  // by HandSide
    std::int32_t priority = 0;                     // of grips in whose zone a hand closes
    // The snap zone: how far the closing hand's palm may be from where the grip has it, and how far
    // it may be turned away.
    double snap_radius_m = 0.08;
    double snap_angle_rad = 1.0471975511965976;
};

// Of a body. Made with it; never changed while frames run.
struct AuthoredGrips {
    std::array<AuthoredGrip, k_max_authored_grips> grips;
    std::uint8_t count = 0;
};

// Which grip a hand sits in: only hands that do have one, and it counts only while the hand's Grab
// is on its body. Written by update_grabs; read by anchor_grabs, gather_surroundings, publish_pose.
struct AuthoredHold {
    Entity body = k_no_entity;
    std::uint8_t grip = 0;         // into AuthoredGrips::grips
    AuthoredHand hand;             // the one of the hand's side
    double leave_angle_rad = 0.0;  // a hand that may turn on its grip leaves it beyond this
};

}  // namespace handhold
