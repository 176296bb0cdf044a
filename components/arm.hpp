#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Arms and chest. No device tracks them: they are estimated from the head and the shown hands. They
// never move a player; hands that grip another player follow a body of their own (GrippableBody).
// Torso axes (_ts): -Z is the horizontal direction in which the chest faces; +Y is the play space's
// up, even if the chest leans.
namespace handhold {

// A player's size. Written by calibrate_players and estimate_sizes, or by the host that adds the
// player.
struct BodyMeasures {
    static constexpr double k_min_m = 0.05;
    static constexpr double k_max_m = 5.0;

    // All lengths are in [k_min_m, k_max_m] times PlayerOrigin::scale.
    double eye_height_m = 1.62;  // standing
    double shoulder_width_m = 0.38;
    double upper_arm_m = 0.30;
    double forearm_m = 0.28;  // distance from elbow to wrist
};

inline BodyMeasures scaled(const BodyMeasures& measures, double scale) {
    return {scale * measures.eye_height_m, scale * measures.shoulder_width_m,
            scale * measures.upper_arm_m, scale * measures.forearm_m};
}

// The first measure that a player of that scale may not have. The name is null if all are right.
struct WrongMeasure {
    const char* name = nullptr;
    double value_m = 0.0;
};
inline WrongMeasure wrong_measure(const BodyMeasures& measures, double scale) {
    // A measure at the end of the range may be rounded past it when it is scaled.
    constexpr double k_rounding = 1e-12;
    const double least_m = (1.0 - k_rounding) * scale * BodyMeasures::k_min_m;
    const double most_m = (1.0 + k_rounding) * scale * BodyMeasures::k_max_m;
    for (const WrongMeasure& one : {WrongMeasure{"eye_height_m", measures.eye_height_m},
                                    WrongMeasure{"shoulder_width_m", measures.shoulder_width_m},
                                    WrongMeasure{"upper_arm_m", measures.upper_arm_m},
                                    WrongMeasure{"forearm_m", measures.forearm_m}}) {
        if (!(one.value_m >= least_m && one.value_m <= most_m)) {  // true for NaN
            return one;
        }
    }
    return {};
}
inline bool are_measures(const BodyMeasures& measures, double scale) {
    return wrong_measure(measures, scale).name == nullptr;
}

// Displacement of the chest from where the head alone would place it.
struct ChestOffset {
    // In the axes of the leaning chest; for a player of eye height k_scale_eye_m.
    Vec3 middle_m = Vec3::Zero();
    double roll = 0.0;  // tangent of the roll angle; positive: the right shoulder is up
};

inline constexpr std::size_t k_look_filters = 3;

// What an arm reaches for. `hand`: the hand as tracked or inferred. `grip`: a hand that grips, also
// a lost one. `rest`: a hand that is lost or was never tracked, and grips nothing.
enum class ArmGoal : std::uint8_t { hand, grip, rest };

// The way of a hand to its rest pose and back (systems/body/shared/rest_hand.hpp).
struct HandRest {
    bool is_away = false;  // true: the goal is ArmGoal::rest
    // Away: passed share of the way from `from_vs` to the rest pose. Else: what is left of the way
    // from `from_vs` back to the hand. [0, 1]
    double share = 0.0;
    Pose from_vs;  // where the way began, in the view's frame
};

// State of estimate_arms between frames.
struct ArmMemory {
    struct Arm {
        Vec3 axis_ts = -Vec3::UnitY();  // unit; from the shoulder to the hand
        Vec3 bend_ts = Vec3::UnitZ();   // unit, perpendicular to axis_ts; towards the elbow
        Vec3 hand_ts = Vec3::Zero();    // hand relative to the shoulder's rest position
        Vec3 elbow_ts = Vec3::Zero();   // elbow relative to the shoulder
        Pose hand_ps;                   // shown hand at the end of the last frame
        HandRest rest;
        // Turn of the shown elbow about the line from shoulder to hand, rad. Of clear_arms.
        double cleared_rad = 0.0;
        bool cleared_known = false;  // false: the next frame turns without a limit on the rate
    };
    bool known = false;  // false: the next frame re-initialises this state
    // The head's look direction after low-pass filters of different time constants, the shortest
    // first. Horizontal unit vectors.
    std::array<Vec3, k_look_filters> looks_ps = {-Vec3::UnitZ(), -Vec3::UnitZ(), -Vec3::UnitZ()};
    Vec3 facing_ps = -Vec3::UnitZ();     // horizontal unit vector: where the chest faces
    ChestOffset chest;                   // low-pass filtered
    Pose head_ps;                        // head at the end of the last frame
    std::array<Arm, k_hand_count> arms;  // indexed by HandSide
};

// Position of a clavicle's inner end (at the base of the neck) on the line from the chest's centre
// to the shoulder: 0 is the centre, 1 the shoulder.
inline constexpr double k_clavicle_from = 0.12;

// Estimated chest, shoulders and elbow directions. Written by estimate_arms; layer_additives adds
// the clavicles' clip.
struct ArmEstimate {
    struct Arm {
        Pose hand_ps;  // shown hand
        ArmGoal goal = ArmGoal::hand;
        Vec3 shoulder_ps = Vec3::Zero();
        Vec3 bend_ps = Vec3::UnitZ();  // unit, perpendicular to the line from shoulder to hand
        double stretch = 1.0;  // >= 1; scale of upper arm and forearm so that they reach the hand
    };
    Pose chest_ps;  // midway between the shoulders' rest positions; -Z ahead, +Y up
    Vec3 facing_ps = -Vec3::UnitZ();  // horizontal unit vector: where the chest faces
    // How far the player lies, [0, 1]. 0: upright, bent or crouching. 1: lying, with the trunk
    // along the head's Y axis.
    double lying = 0.0;
    // Vector to the chest from the point about which the neck bends (neck_pivot). If only the neck
    // bends, that point stays in place, although the estimated chest moves a little.
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
