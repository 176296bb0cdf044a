#pragma once

#include <array>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Arms and chest. No device tracks them: they are estimated from the head and the shown hands. They
// never move their own player; hands that grip another player follow that player's arms as the last
// frame showed them (BodyHold). Torso axes (_ts): -Z is the horizontal direction in which the chest
// faces; +Y is the play space's up, even if the chest leans.
namespace handhold {

// A player's size. Written by calibrate_players, or by the host that adds the player.
struct BodyMeasures {
    static constexpr double k_min_m = 0.05;
    static constexpr double k_max_m = 5.0;

    double eye_height_m = 1.62;  // standing; all lengths are in [k_min_m, k_max_m]
    double shoulder_width_m = 0.38;
    double upper_arm_m = 0.30;
    double forearm_m = 0.28;  // distance from elbow to wrist
};

// Displacement of the chest from where the head alone would place it.
struct ChestOffset {
    Vec3 middle_m = Vec3::Zero();  // axes of the leaning chest; for k_scale_eye_m
    double roll = 0.0;             // tangent; positive: the right shoulder is up
};

inline constexpr std::size_t k_look_filters = 3;

// State of estimate_arms between frames.
struct ArmMemory {
    struct Arm {
        Vec3 axis_ts = -Vec3::UnitY();  // unit; from the shoulder to the hand
        Vec3 bend_ts = Vec3::UnitZ();   // unit, perpendicular to axis_ts; towards the elbow
        Vec3 hand_ts = Vec3::Zero();    // hand relative to the shoulder's rest position
        Vec3 elbow_ts = Vec3::Zero();   // elbow relative to the shoulder
        Pose hand_ps;                   // shown hand at the end of the last frame
    };
    bool known = false;  // false: the next frame re-initialises this state
    // Horizontal unit vectors: the head's look direction, low-pass filtered, from fast to slow.
    std::array<Vec3, k_look_filters> looks_ps = {-Vec3::UnitZ(), -Vec3::UnitZ(), -Vec3::UnitZ()};
    Vec3 facing_ps = -Vec3::UnitZ();     // horizontal unit vector: where the chest faces
    ChestOffset chest;                   // low-pass filtered
    Pose head_ps;                        // head at the end of the last frame
    std::array<Arm, k_hand_count> arms;  // indexed by HandSide
};

// Position of a clavicle's inner end (at the base of the neck) on the line from the chest's centre
// to the shoulder: 0 is the centre, 1 the shoulder.
inline constexpr double k_clavicle_from = 0.12;

// Estimated chest, shoulders and elbow directions. Written by estimate_arms.
struct ArmEstimate {
    struct Arm {
        Pose hand_ps;  // shown hand
        Vec3 shoulder_ps = Vec3::Zero();
        Vec3 bend_ps = Vec3::UnitZ();  // unit, perpendicular to the line from shoulder to hand
        double stretch = 1.0;  // >= 1; scale of upper arm and forearm so that they reach the hand
    };
    Pose chest_ps;  // midway between the shoulders' rest positions; -Z ahead, +Y up
    Vec3 facing_ps = -Vec3::UnitZ();  // horizontal unit vector: where the chest faces
    double lying = 0.0;               // [0, 1]; 1: the player lies, the trunk as the head's +Y
    // From the point about which a neck bends, which stays if nothing else moves, to the chest.
    Vec3 from_neck_m = Vec3::Zero();
    std::array<Arm, k_hand_count> arms;  // indexed by HandSide
};

// World poses of the arms' joints. Each bone lies along its frame's -Z; +Y points to the elbow's
// side. Written by pose_arms.
struct ArmPose {
    struct Arm {
        Pose clavicle_ws;  // origin: base of the neck
        Pose upper_ws;     // origin: shoulder
        Pose forearm_ws;   // origin: elbow
        Pose hand_ws;      // equals PalmPose exactly
    };
    Pose chest_ws;
    std::array<Arm, k_hand_count> arms;  // indexed by HandSide
};

}  // namespace handhold
