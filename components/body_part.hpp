#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "components/arm.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "engine/math/math.hpp"

// Parts of a player's body that other players' hands can grip.
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

// A hand's grip on a part of another player's body. Only hands with such a grip have this
// component; a hand that grips a head has none. The poses are those of the part's bone
// (GrippableBody) in the held player's play space. They follow the bone with a delay of at least
// one frame (HandTuning::part_speed_mps, swing_lag_s). Written by update_grabs. When the held
// player turns, locomote_players changes the poses so that they stay in place in the world.
struct BodyHold {
    BodyPart part = BodyPart::left_upper_arm;
    Pose start_ps;  // pose at the start of the frame
    Pose pose_ps;   // pose at the end of the frame
};

// A player's arms, trunk and legs where other players' hands can grip them: a function of the
// tracked head and wrists at the start of the frame alone. The shown body lags and swings about it.
// Not state: written by pose_grippable_bodies, for players who may be gripped in the frame.
struct GrippableBody {
    ArmPose arms;
    SpinePose spine;
};
// Distance from the head, in eye heights, beyond which hands find no part.
inline constexpr double k_grippable_eyes = 2.0;

// Scratch memory of pose_grippable_bodies for one player.
struct GrippablePlayer {
    // Indices of the hands in the column HandOwner, by side; its size where a hand is missing.
    std::array<std::size_t, k_hand_count> hands{};
    bool closes = false;  // one of the hands may begin to grip in this frame
    Vec3 head_ws = Vec3::Zero();
    double body_reach_m = 0.0;  // distance from the head within which the parts are
    bool is_tracked = false;    // the head, now or earlier
};

}  // namespace handhold
