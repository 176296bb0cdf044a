#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/math/math.hpp"

// Parts of a player's shown body that other players' hands can grip.
namespace handhold {

enum class BodyPart : std::uint8_t {
    left_upper_arm,
    left_forearm,
    left_hand,
    right_upper_arm,
    right_forearm,
    right_hand,
    upper_spine,
    middle_spine,
    lower_spine,
    left_thigh,
    left_shin,
    right_thigh,
    right_shin,
};
inline constexpr std::size_t k_gripped_parts = 13;

// True for trunk and legs: they swing when the player is pulled, while arms follow tracked hands.
inline constexpr bool swings(BodyPart part) { return part >= BodyPart::upper_spine; }

// A hand's grip on a part of another player's body. Only such hands have it; a hand that grips a
// head has none. Poses are in the held player's play space and follow the shown part, at least one
// frame later (HandTuning::part_speed_mps, swing_lag_s). The frame is the bone's (ArmPose,
// SpinePose). Written by update_grabs; locomote_players keeps it in place in the world when the
// held player turns.
struct BodyHold {
    BodyPart part = BodyPart::left_upper_arm;
    Pose start_ps;  // pose at the start of the frame
    Pose pose_ps;   // pose at the end of the frame
};

}  // namespace handhold
