#pragma once

#include <array>

#include "engine/math/math.hpp"

// Numbers of the body that follows head and hands. Lengths that scale with the player are those of
// one whose eyes are at k_scale_eye_m.
namespace handhold {

inline constexpr double k_scale_eye_m = 1.6;
// Faster than hands, head and chest move in play space: what jumps farther in a frame was put
// there.
inline bool is_jump(double distance_m, double dt_s) {
    constexpr double k_jump_m = 0.15;
    constexpr double k_jump_speed_mps = 20.0;
    return distance_m > k_jump_m + k_jump_speed_mps * dt_s;
}

// Fitted on motion capture. Subjects and scores: docs/decisions/0034-chest-and-elbow-estimate.md.
struct ArmTuning {
    double head_lag_s = 0.3;
    double hand_share = 0.15;
    double line_share = 1.35;
    double roll_share = 0.1;
    double behind_fade = 0.0;
    double chest_limit_rad = 1.3962634015954636;
    double lean = 0.5;
    double neck_m = 0.16;
    Vec3 shoulder_offset_m = Vec3(0.0, -0.061, 0.07);
    double clavicle_lift = 0.35;
    double clavicle_share = 0.8;
    double reach = 0.995;
    double shoulder_follow_m = 0.06;
    Vec3 pole_rest = Vec3(0.199, -0.286, 0.305);
    double pole_fingers = -0.551;
    double pole_back = 0.142;
    double pole_thumb = -0.337;
    double swivel_lag_s = 0.08;
    double swivel_speed_radps = 15.0;
    double elbow_inertia = 0.5;
    Vec3 elbow_cone = Vec3(0.54, -0.64, -0.54);
    double elbow_cone_cosine = -0.087;
    double chest_speed_radps = 12.0;
};

struct CalibrationTuning {
    double hold_s = 1.0;
    double still_m = 0.05;
};

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
};

// Weights of the clips that lie on top (systems/rigs/body_clips.hpp); 0: none of it.
struct AdditiveTuning {
    double idle = 1.0;
    double push_off = 1.0;
    double push_off_speed_mps = 1.5;
    double look = 1.0;
    double clavicle = 1.0;
};

// The lines of visit_tuning (components/tuning.hpp) for all of them.
template <typename TuningType, typename See>
void visit_body_tuning(TuningType& t, const See& see) {
    see("arm.head_lag_s", t.arm.head_lag_s, "s", 0.0, 10.0,
        "the chest follows where the head looks this much later");
    see("arm.hand_share", t.arm.hand_share, "", 0.0, 10.0,
        "how much the chest turns to where the hands are");
    see("arm.line_share", t.arm.line_share, "", 0.0, 10.0,
        "how much the chest turns to face square to the line between the hands");
    see("arm.roll_share", t.arm.roll_share, "", -3.0, 3.0,
        "how much the chest turns with hands that roll");
    see("arm.behind_fade", t.arm.behind_fade, "", 0.0, 1.0,
        "1: hands behind the body do not turn the chest; 0: they do as all others");
    see("arm.chest_limit_rad", t.arm.chest_limit_rad, "rad", 0.0, 3.0,
        "the chest turns at most this far from where the head looks");
    see("arm.lean", t.arm.lean, "", 0.0, 1.0, "the chest leans by this share of the head's tilt");
    see("arm.neck_m", t.arm.neck_m, "m", 0.0, 1.0, "from the eyes down along the head's up");
    see("arm.shoulder_offset_m", t.arm.shoulder_offset_m, "m", -1.0, 1.0,
        "from there to the middle between the shoulders, in the chest's axes");
    see("arm.clavicle_lift", t.arm.clavicle_lift, "", -1.0, 1.0,
        "a hand lower than this by arm lengths lowers the shoulder, a higher one lifts it");
    see("arm.clavicle_share", t.arm.clavicle_share, "", 0.0, 3.0,
        "of the clavicle's reach; 0: a rigid one");
    see("arm.reach", t.arm.reach, "", 0.5, 1.0,
        "an arm straighter than this share of its length takes the shoulder along, then stretches");
    see("arm.shoulder_follow_m", t.arm.shoulder_follow_m, "m", 0.0, 0.5,
        "how far the shoulder is taken along before the bones stretch");
    see("arm.pole_rest", t.arm.pole_rest, "", -3.0, 3.0,
        "to where an elbow points at rest, right arm, in the chest's axes");
    see("arm.pole_fingers", t.arm.pole_fingers, "", -3.0, 3.0, "and how much to the fingers");
    see("arm.pole_back", t.arm.pole_back, "", -3.0, 3.0, "to the back of the hand");
    see("arm.pole_thumb", t.arm.pole_thumb, "", -3.0, 3.0, "to the thumb's side");
    see("arm.swivel_lag_s", t.arm.swivel_lag_s, "s", 0.0, 10.0,
        "the elbow follows that this much later");
    see("arm.swivel_speed_radps", t.arm.swivel_speed_radps, "rad/s", 0.1, 1e3,
        "an elbow turns about the line to the hand at most this fast");
    see("arm.elbow_cone", t.arm.elbow_cone, "", -1.0, 1.0,
        "the middle of where a right upper arm can point, in torso axes");
    see("arm.elbow_cone_cosine", t.arm.elbow_cone_cosine, "", -2.0, 1.0,
        "and how far from it, as the cosine of the angle; -1 and below: anywhere");
    see("arm.elbow_inertia", t.arm.elbow_inertia, "", 0.0, 1.0,
        "share in which a bent arm's elbow stays where it was while the hand moves");
    see("arm.chest_speed_radps", t.arm.chest_speed_radps, "rad/s", 0.1, 1e3,
        "the chest turns at most this fast");
    see("calibration.hold_s", t.calibration.hold_s, "s", 0.1, 10.0,
        "a T-pose is held so long before it is measured");
    see("calibration.still_m", t.calibration.still_m, "m", 1e-3, 0.5,
        "and the hands move no farther meanwhile");
    see("spine.spine_limit_rad", t.spine.spine_limit_rad, "rad", 0.01, 1.5,
        "bend of each link of the spine against the one above");
    see("spine.hip_limit_rad", t.spine.hip_limit_rad, "rad", 0.01, 1.5,
        "swing of a thigh from its rest");
    see("spine.knee_limit_rad", t.spine.knee_limit_rad, "rad", 0.01, 2.5,
        "bend of a knee, backwards only");
    see("spine.limit_lag_s", t.spine.limit_lag_s, "s", 0.0, 1.0,
        "a link that swings towards a limit comes to rest there in about this time");
    see("spine.return_per_s", t.spine.return_per_s, "1/s", 0.0, 100.0,
        "how fast each link goes back to its rest against the one above");
    see("spine.drag_per_s", t.spine.drag_per_s, "1/s", 0.0, 100.0,
        "drag of the chain, against the reference velocity");
    see("spine.hand_back", t.spine.hand_back, "", 0.0, 1.0,
        "share of what the chain corrects at a joint that its parent feels; above 0.5 it does not "
        "settle");
    see("spine.speed_max_mps", t.spine.speed_max_mps, "m/s", 0.1, 1000.0,
        "no joint moves faster, against the reference velocity");
    see("spine.twist_lag_s", t.spine.twist_lag_s, "s", 0.0, 10.0,
        "each link turns about its length this much later than the one above");
    see("spine.twist_limit_rad", t.spine.twist_limit_rad, "rad", 0.0, 1.5,
        "twist of each link against the one above");
    see("additive.idle", t.additive.idle, "", 0.0, 3.0, "weight of the idle clip");
    see("additive.push_off", t.additive.push_off, "", 0.0, 3.0,
        "weight of the clip that plays when the last hand lets go");
    see("additive.push_off_speed_mps", t.additive.push_off_speed_mps, "m/s", 0.3, 100.0,
        "it plays in full from this speed on, not at all below 0.2 m/s");
    see("additive.look", t.additive.look, "", 0.0, 3.0,
        "weight of the clips by where the head looks");
    see("additive.clavicle", t.additive.clavicle, "", 0.0, 3.0,
        "weight of the clavicles' clip; on top of arm.clavicle_share");
}

}  // namespace handhold
