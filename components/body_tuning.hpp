#pragma once

#include <array>

#include "engine/math/math.hpp"

// Tuning of the body that follows head and hands: arms, spine, legs and clips. Lengths are for a
// player with an eye height of k_scale_eye_m and scale with the player.
namespace handhold {

inline constexpr double k_scale_eye_m = 1.6;
// True if a hand, head or chest moved farther in one frame than a person can move it. The part was
// then repositioned (for example re-centred), and its history does not apply.
inline bool is_jump(double distance_m, double dt_s) {
    constexpr double k_jump_m = 0.15;
    constexpr double k_jump_speed_mps = 20.0;
    return distance_m > k_jump_m + k_jump_speed_mps * dt_s;
}

// Chest, shoulders and elbows: constants chosen by eye. Those fitted to data are in
// systems/body/shared/body_constants.hpp.
struct ArmTuning {
    double learned = 1.0;
    double chest_limit_rad = 1.3962634015954636;
    double chest_lag_s = 0.05;
    double chest_speed_radps = 12.0;
    double clavicle_lift = 0.35;
    double clavicle_share = 0.8;
    double reach = 0.995;
    double shoulder_follow_m = 0.06;
    double swivel_lag_s = 0.05;
    double swivel_speed_radps = 9.0;
    double elbow_inertia = 0.5;
    Vec3 elbow_cone = Vec3(0.54, -0.64, -0.54);
    double elbow_cone_cosine = -0.087;
};

// T-pose calibration.
struct CalibrationTuning {
    double hold_s = 1.0;
    double still_m = 0.05;
};

// Spine and legs, which trail behind the chest.
struct SpineTuning {
    double spine_limit_rad = 0.4;
    double hip_limit_rad = 1.0471975511965976;
    double knee_limit_rad = 1.2217304763960306;
    double limit_lag_s = 0.02;
    double return_per_s = 1.5;
    double drag_per_s = 2.5;
    double hand_back = 0.5;
    double speed_max_mps = 12.0;
    double twist_lag_s = 0.12;
    double twist_limit_rad = 0.35;
    double hang = 0.8;
    double hang_lag_s = 0.6;
};

// Weights of the additive clips (systems/rigs/body_clips.hpp); 0: off.
struct AdditiveTuning {
    double idle = 1.0;
    double push_off = 1.0;
    double push_off_speed_mps = 1.5;
    double look = 1.0;
    double clavicle = 1.0;
};

// The part of visit_tuning (components/tuning.hpp) for these structs.
template <typename TuningType, typename See>
void visit_body_tuning(TuningType& t, const See& see) {
    see("arm.learned", t.arm.learned, "", 0.0, 1.0,
        "Weight with which fitted neural networks correct the estimated chest and elbows; 0: "
        "none.");
    see("arm.chest_limit_rad", t.arm.chest_limit_rad, "rad", 0.0, 3.0,
        "Maximum angle between the chest's facing and the head's look direction.");
    see("arm.chest_lag_s", t.arm.chest_lag_s, "s", 0.0, 10.0,
        "Time constant with which the chest follows its estimate.");
    see("arm.clavicle_lift", t.arm.clavicle_lift, "", -1.0, 1.0,
        "Hand height below the shoulder, in arm lengths, at which the clavicle is level; higher "
        "hands raise it.");
    see("arm.clavicle_share", t.arm.clavicle_share, "", 0.0, 3.0,
        "Scale of the clavicle's movement; 0: rigid clavicles.");
    see("arm.reach", t.arm.reach, "", 0.5, 1.0,
        "Distance of a hand from its shoulder, as a share of the arm's length, above which the "
        "shoulder follows the hand. The bones stretch only after that.");
    see("arm.shoulder_follow_m", t.arm.shoulder_follow_m, "m", 0.0, 0.5,
        "Maximum movement of a shoulder by clavicle and reach together, before the bones stretch; "
        "movement by the clavicle alone is not limited.");
    see("arm.swivel_lag_s", t.arm.swivel_lag_s, "s", 0.0, 10.0,
        "Time constant with which an elbow follows its wanted direction.");
    see("arm.swivel_speed_radps", t.arm.swivel_speed_radps, "rad/s", 0.1, 1e3,
        "Maximum angular speed of an elbow about the line from shoulder to hand.");
    see("arm.elbow_cone", t.arm.elbow_cone, "", -1.0, 1.0,
        "Axis of the cone of directions in which a right upper arm can point, in torso axes.");
    see("arm.elbow_cone_cosine", t.arm.elbow_cone_cosine, "", -2.0, 1.0,
        "Cosine of the half angle of the cone arm.elbow_cone; -1 or less: no limit.");
    see("arm.elbow_inertia", t.arm.elbow_inertia, "", 0.0, 1.0,
        "How much a bent arm's elbow keeps its position while the hand moves; 0: not at all, 1: "
        "fully.");
    see("arm.chest_speed_radps", t.arm.chest_speed_radps, "rad/s", 0.1, 1e3,
        "Maximum angular speed of the chest.");
    see("calibration.hold_s", t.calibration.hold_s, "s", 0.1, 10.0,
        "Time for which a T-pose must be held before it is measured.");
    see("calibration.still_m", t.calibration.still_m, "m", 1e-3, 0.5,
        "Maximum hand movement while a T-pose is held.");
    see("spine.spine_limit_rad", t.spine.spine_limit_rad, "rad", 0.01, 1.5,
        "Maximum bend of each spine link against the link above.");
    see("spine.hip_limit_rad", t.spine.hip_limit_rad, "rad", 0.01, 1.5,
        "Maximum swing of a thigh from its rest direction.");
    see("spine.knee_limit_rad", t.spine.knee_limit_rad, "rad", 0.01, 2.5,
        "Maximum bend of a knee, backwards only.");
    see("spine.limit_lag_s", t.spine.limit_lag_s, "s", 0.0, 1.0,
        "Time constant of a link's fastest approach to a joint limit: it slows down and does "
        "not stop abruptly.");
    see("spine.return_per_s", t.spine.return_per_s, "1/s", 0.0, 100.0,
        "Rate at which each link returns to its rest direction against the link above.");
    see("spine.drag_per_s", t.spine.drag_per_s, "1/s", 0.0, 100.0,
        "Drag rate of the spine and legs relative to the reference velocity.");
    see("spine.hand_back", t.spine.hand_back, "", 0.0, 1.0,
        "Damping of spine and legs: share of a joint's velocity correction that is subtracted "
        "from its parent joint. Above 0.5 the chain oscillates.");
    see("spine.speed_max_mps", t.spine.speed_max_mps, "m/s", 0.1, 1000.0,
        "Maximum speed of any spine or leg joint relative to the reference velocity.");
    see("spine.twist_lag_s", t.spine.twist_lag_s, "s", 0.0, 10.0,
        "Time constant with which each link's twist follows the link above.");
    see("spine.twist_limit_rad", t.spine.twist_limit_rad, "rad", 0.0, 1.5,
        "Maximum twist of each link against the link above.");
    see("spine.hang", t.spine.hang, "", 0.0, 10.0,
        "Strength with which the trunk turns to hang from the gripping hands; 0: off. At 1, a hand "
        "at arm's length turns the trunk through 0.7 of the angle to hanging straight.");
    see("spine.hang_lag_s", t.spine.hang_lag_s, "s", 0.0, 10.0,
        "Mean delay with which the trunk follows the pull of the hands.");
    see("additive.idle", t.additive.idle, "", 0.0, 3.0, "Weight of the idle clip; 0: off.");
    see("additive.push_off", t.additive.push_off, "", 0.0, 3.0,
        "Weight of the push-off clip that plays when the last hand lets go; 0: off.");
    see("additive.push_off_speed_mps", t.additive.push_off_speed_mps, "m/s", 0.3, 100.0,
        "Player speed at a push-off from which the clip plays in full; below 0.2 m/s it does not "
        "play.");
    see("additive.look", t.additive.look, "", 0.0, 3.0,
        "Weight of the clips driven by the head's look direction; 0: off.");
    see("additive.clavicle", t.additive.clavicle, "", 0.0, 3.0,
        "Weight of the clavicle clip, which adds to the movement that arm.clavicle_share scales; "
        "0: off.");
}

}  // namespace handhold
