#pragma once

#include <array>

#include "components/spine.hpp"
#include "engine/math/math.hpp"

// Folds the trunk and the legs of players whose head is too low for the body to hang straight.
//
// The player's real body is above the tracked floor (y = 0 of the tracking space). When the eyes
// come down, first hips and knees flex (squat), then the trunk leans forward; close to the floor
// the knees come down too (kneeling). A player who lies (lie_down.hpp) is not folded. All angles
// are continuous functions of the head's height. Lengths in this file are for a body with an eye
// height of k_scale_eye_m.
namespace handhold {

// Bone lengths, metres. The spine's links are listed from the top down.
inline constexpr std::array<double, k_spine_links> k_spine_link_m = {0.20, 0.16, 0.13};
inline constexpr double k_thigh_m = 0.40;
inline constexpr double k_shin_m = 0.39;
// Distance of the hip joints below the pelvis and to its sides, in the pelvis' axes.
inline constexpr double k_hip_below_m = 0.03;
inline constexpr double k_hip_aside_m = 0.09;
// Rest directions of the hanging leg, as tangents of angles: the thigh points forward of the
// pelvis' -Y, the shin backward of the thigh's direction.
inline constexpr double k_thigh_rest_forward = 0.25;
inline constexpr double k_shin_rest_back = 0.40;
inline constexpr double k_toes_rest_rad = -0.6;  // relative to the shin; positive: toes up

// Minimum heights of folded joints above the floor.
inline constexpr double k_pelvis_clearance_m = 0.12;
inline constexpr double k_knee_clearance_m = 0.06;
inline constexpr double k_ankle_clearance_m = 0.05;
inline constexpr double k_lying_clearance_m = 0.05;  // half the thickness of a lying trunk or leg

// Lowest height of the pelvis. The trunk starts to fold when the pelvis of the straight trunk is
// less than k_seat_width_m above this height.
inline constexpr double k_seat_m = 0.20;
inline constexpr double k_seat_width_m = 0.12;

// Turns that fold the trunk: about the X axis of the frame of the link above. A positive turn moves
// the link's lower end backwards.
struct TrunkFold {
    std::array<double, k_spine_links> bend_rad{};
    double lean_rad = 0.0;  // sum of bend_rad
};
// chest_m: height of the chest above the floor. up_cs: the floor's normal in the chest's axes, a
// unit vector. All turns are zero while the pelvis of the straight trunk is at least k_seat_m +
// k_seat_width_m above the floor.
TrunkFold fold_trunk(double chest_m, const Vec3& up_cs);

// Turns about X that fold a leg. All are zero while a hanging leg has enough height.
struct LegFold {
    double thigh_rad = 0.0;  // forwards, relative to the pelvis
    double knee_rad = 0.0;   // backwards, relative to the thigh
    double toes_rad = 0.0;   // upwards, relative to the shin
};
// pelvis_m: height of the pelvis above the floor. up_pelvis: the floor's normal in the pelvis'
// axes, a unit vector. lean_rad: TrunkFold::lean_rad.
LegFold fold_legs(double pelvis_m, const Vec3& up_pelvis, double lean_rad);

// True if the legs of an upright pelvis at this height fold.
bool legs_fold(double pelvis_m);

// Range of a knee's bend. A straight leg looks like a plank.
inline constexpr double k_least_knee_rad = 0.15;
inline constexpr double k_knee_max_rad = 2.8;

}  // namespace handhold
