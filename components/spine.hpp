#pragma once

#include <array>
#include <cstddef>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Spine and legs: a chain below the chest that follows the player's motion link by link. For
// display only. Bone frames have -Y down the bone and -Z to the front.
namespace handhold {

inline constexpr std::size_t k_spine_links = 3;  // the last link ends at the pelvis
// Links: spine from the top down, then left thigh and shin, then right thigh and shin.
inline constexpr std::size_t k_body_links = k_spine_links + 2 * k_hand_count;
using BodyLinkVectors = std::array<Vec3, k_body_links>;
inline BodyLinkVectors zero_vectors() {
    BodyLinkVectors zero;
    zero.fill(Vec3::Zero());
    return zero;
}

// A surface that a leg must not cross. A joint at p, measured from the chest at the end of the last
// frame in play-space axes, satisfies normal_ps . p >= least distance. The surface moves with the
// reference velocity.
struct LegContact {
    bool touches = false;
    Vec3 normal_ps = Vec3::UnitY();  // unit, on the head's side
    double surface_m = 0.0;          // least distance of a knee
    double ankle_m = 0.0;            // least distance of an ankle that keeps the sole in front
};

// State of propagate_spine: the hanging chain, before it is folded for a crouch. Offsets are from
// the chest to each link's lower end, in play-space axes. Velocities are relative to
// `reference_ws_mps`. The chain advances in ticks of its own.
struct SpineMemory {
    bool known = false;                     // false: the next frame starts from rest
    double since_tick_s = 0.0;              // [0, a tick)
    Vec3 moved_m = Vec3::Zero();            // chest displacement since the last tick, relative
    Pose chest_ps;                          // at the end of the last frame
    Vec3 rate_mps = Vec3::Zero();           // chest velocity in the last frame, relative
    double rate_span_s = 1.0;               // duration of that frame; > 0
    Quat tick_chest_ps = Quat::Identity();  // at the last tick
    Vec3 reference_ws_mps = Vec3::Zero();
    BodyLinkVectors offset_m = zero_vectors();  // at the last tick
    BodyLinkVectors before_m = zero_vectors();  // one tick earlier; frames interpolate
    BodyLinkVectors velocity_mps = zero_vectors();
    std::array<double, k_spine_links> twist_rad{};  // of each link relative to the one above
    std::array<double, k_body_links> angle_rad{};   // from the rest pose; knees: from straight
    std::array<LegContact, k_hand_count> contacts;  // by side
};

// Written by propagate_spine.
struct SpinePose {
    struct Leg {
        Pose thigh_ws;  // from the hip
        Pose shin_ws;   // from the knee
        Pose foot_ws;   // at the ankle; -Z towards the toes
    };
    Pose chest_ws;                             // leans with the head
    std::array<Pose, k_spine_links> spine_ws;  // at the upper end of each link
    Pose pelvis_ws;                            // at the lower end of the last link
    std::array<Leg, k_hand_count> legs;        // by side
};

}  // namespace handhold
