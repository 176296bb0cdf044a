#pragma once

#include <array>
#include <cstddef>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// What hangs below the chest: a chain that the player's motion is handed down, link by link. It is
// shown only. Frames of its bones have -Y down the bone and -Z to the front.
namespace handhold {

inline constexpr std::size_t k_spine_links = 3;  // the last one ends at the pelvis
// Spine from the top down, then thigh and shin of the left leg, then of the right.
inline constexpr std::size_t k_body_links = k_spine_links + 2 * k_hand_count;
using BodyLinkVectors = std::array<Vec3, k_body_links>;
inline BodyLinkVectors zero_vectors() {
    BodyLinkVectors zero;
    zero.fill(Vec3::Zero());
    return zero;
}

// A surface that a leg stays before: normal_ps . point >= least, from the chest at the last frame's
// end, in play space's axes. It moves with the reference velocity.
struct LegContact {
    bool touches = false;
    Vec3 normal_ps = Vec3::UnitY();  // unit, to the head's side
    double surface_m = 0.0;          // least for a knee
    double ankle_m = 0.0;            // least for an ankle, so that the sole is before it
};

// What propagate_spine remembers. Offsets are from the chest to each link's lower end, in play
// space's axes; velocities are against `reference_ws_mps`. The chain lives on a clock of its own.
struct SpineMemory {
    bool known = false;            // false: the next frame starts at rest
    double since_tick_s = 0.0;     // [0, a tick)
    Vec3 moved_m = Vec3::Zero();   // by the chest since the last tick, against the reference
    Pose chest_ps;                 // at the last frame's end
    Vec3 rate_mps = Vec3::Zero();  // of the chest in the last frame, as moved_m
    double rate_span_s = 1.0;      // how long that was; > 0
    Quat tick_chest_ps = Quat::Identity();  // at the last tick
    Vec3 reference_ws_mps = Vec3::Zero();
    BodyLinkVectors offset_m = zero_vectors();  // at the last tick
    BodyLinkVectors before_m = zero_vectors();  // one tick earlier: what is shown lies between
    BodyLinkVectors velocity_mps = zero_vectors();
    std::array<double, k_spine_links> twist_rad{};  // of each link against the one above
    std::array<double, k_body_links> angle_rad{};   // from the rest; of a knee, from straight
    std::array<LegContact, k_hand_count> contacts;  // by side
};

// Written by propagate_spine.
struct SpinePose {
    struct Leg {
        Pose thigh_ws;  // from the hip
        Pose shin_ws;   // from the knee
        Pose foot_ws;   // at the ankle; -Z to the toes
    };
    Pose chest_ws;                             // torso space, leaning with the head
    std::array<Pose, k_spine_links> spine_ws;  // from the upper end of each link
    Pose pelvis_ws;                            // at the lower end of the last
    std::array<Leg, k_hand_count> legs;        // by side
};

}  // namespace handhold
