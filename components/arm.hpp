#pragma once

#include <array>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Arms and chest, which nothing tracks: estimated from the head and the two hands as they are
// shown. They are shown only: nothing here ever moves the player. Torso axes (_ts): -Z where the
// chest faces, +Y the play space's up, whether the chest leans or not.
namespace handhold {

// What a player can be asked. Written by calibrate_players, or by whoever makes the player.
struct BodyMeasures {
    static constexpr double k_min_m = 0.05;
    static constexpr double k_max_m = 5.0;

    double eye_height_m = 1.62;  // standing; all [k_min_m, k_max_m]
    double shoulder_width_m = 0.38;
    double upper_arm_m = 0.30;
    double forearm_m = 0.28;  // to the wrist
};

// What estimate_arms remembers from frame to frame.
struct ArmMemory {
    struct Arm {
        Vec3 axis_ts = -Vec3::UnitY();  // unit: from the shoulder to the hand
        Vec3 bend_ts = Vec3::UnitZ();   // unit, square to it: to the elbow
        Vec3 hand_ts = Vec3::Zero();    // from the shoulder at rest
        Vec3 elbow_ts = Vec3::Zero();   // from the shoulder
        Pose hand_ps;                   // as it was shown at the last frame's end
    };
    bool known = false;                  // false: the next frame starts afresh
    Vec3 look_ps = -Vec3::UnitZ();       // unit, level: where the head looks, low-passed
    Vec3 facing_ps = -Vec3::UnitZ();     // unit, level: where the chest faces
    Pose head_ps;                        // at the last frame's end
    std::array<Arm, k_hand_count> arms;  // by HandSide
};

// The clavicles begin at the base of the neck: this share of the way out to the shoulders.
inline constexpr double k_clavicle_from = 0.12;

// Where chest, shoulders and elbows ought to be. Written by estimate_arms.
struct ArmEstimate {
    struct Arm {
        Pose hand_ps;  // as it is shown
        Vec3 shoulder_ps = Vec3::Zero();
        Vec3 bend_ps = Vec3::UnitZ();  // unit, square to the line from the shoulder to the hand
        double stretch = 1.0;          // [1, ...): of both bones, so that the hand is reached
    };
    Pose chest_ps;                       // between the shoulders at rest; -Z ahead, +Y its own up
    Vec3 facing_ps = -Vec3::UnitZ();     // unit, level: where the chest faces
    std::array<Arm, k_hand_count> arms;  // by HandSide
};

// The arms' joints. Bones lie along their frame's -Z, with +Y towards the side the elbow points
// to. Written by pose_arms.
struct ArmPose {
    struct Arm {
        Pose clavicle_ws;  // from the base of the neck
        Pose upper_ws;     // from the shoulder
        Pose forearm_ws;   // from the elbow
        Pose hand_ws;      // PalmPose, bit for bit
    };
    Pose chest_ws;
    std::array<Arm, k_hand_count> arms;  // by HandSide
};

}  // namespace handhold
