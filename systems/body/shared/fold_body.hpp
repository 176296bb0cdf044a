#pragma once

#include <array>

#include "components/spine.hpp"
#include "engine/math/math.hpp"

// How the trunk and the legs fold when the head is too low for them to hang straight.
//
// The tracked floor (y = 0 of the tracking space) bounds the player's real body. When the eyes come
// down, first hips and knees flex (squat), then the trunk leans forward, and close to the floor the
// knees come down too (kneeling). All angles are continuous in the head's height.
// Lengths in this file are those of a body whose eyes are at k_scale_eye_m.
namespace handhold {

// Bone lengths, metres; the spine from the top down.
inline constexpr std::array<double, k_spine_links> k_spine_link_m = {0.20, 0.16, 0.13};
inline constexpr double k_thigh_m = 0.40;
inline constexpr double k_shin_m = 0.39;
// Hip joints lie this far below the pelvis and to each side of it, in the pelvis' axes.
inline constexpr double k_hip_below_m = 0.03;
inline constexpr double k_hip_aside_m = 0.09;
// Directions of the hanging leg: how far forward of -Y the thigh points, in the pelvis' axes, and
// how far back of the thigh the shin; as tangents.
inline constexpr double k_thigh_rest_forward = 0.25;
inline constexpr double k_shin_rest_back = 0.40;
inline constexpr double k_toes_rest_rad = -0.6;  // upwards, against the shin

// Lowest heights above the floor that folded joints may take.
inline constexpr double k_pelvis_clearance_m = 0.12;
inline constexpr double k_knee_clearance_m = 0.06;
inline constexpr double k_ankle_clearance_m = 0.05;

// Turns added about each link's X axis, in the frame of the link above. Positive turns the lower
// end backwards.
struct TrunkFold {
    std::array<double, k_spine_links> bend_rad{};
    double lean_rad = 0.0;  // their sum
};
// chest_m: height of the chest above the floor. up_cs: unit, the floor's normal in the chest's
// axes. All zero while the pelvis of a straight trunk keeps 0.32 m above the floor.
TrunkFold fold_trunk(double chest_m, const Vec3& up_cs);

// Turns about X: thigh forwards, shin and toes as named. Zero while a hanging leg has enough
// height.
struct LegFold {
    double thigh_rad = 0.0;  // forwards, against the pelvis
    double knee_rad = 0.0;   // backwards, against the thigh
    double toes_rad = 0.0;   // upwards, against the shin
};
// pelvis_m: height of the pelvis above the floor. up_pelvis: unit, the floor's normal in the
// pelvis' axes. lean_rad: of the trunk (TrunkFold).
LegFold fold_legs(double pelvis_m, const Vec3& up_pelvis, double lean_rad);

// True if the legs fold at this pelvis height, for an upright pelvis.
bool legs_fold(double pelvis_m);

// The tallest reach of a knee: the shin is never folded closer to the thigh than this.
inline constexpr double k_knee_max_rad = 2.8;

}  // namespace handhold
