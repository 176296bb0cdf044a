#pragma once

#include <cstdint>

#include "components/body_tuning.hpp"
#include "engine/math/math.hpp"

// Every number a designer may turn. Each is declared here with its default and described once, with
// unit and range, in visit_tuning: files, the report and the inspector read that.
namespace handhold {

struct TrackingTuning {
    double lost_after_s = 0.25;
    double max_jump_m = 2.0;
    double release_window_s = 0.06;
    double max_hand_speed_mps = 8.0;
};

struct HandTuning {
    Vec3 controller_offset_m = Vec3(0.0, 0.0, 0.09);  // wrist in the controller's frame, right hand
    double controller_pitch_rad = -0.35;
    Vec3 palm_center_m = Vec3(0.0, -0.014, -0.08);  // in the hand's frame
    double ray_back_m = 0.03;
    double ray_length_m = 0.15;
    double reach_m = 0.10;
    double max_stretch_m = 0.3;
    double max_arm_m = 2.0;
    double return_speed_mps = 2.0;
};

// Distance grab: a hand that closes on nothing pulls what its palm points at.
struct PullTuning {
    double reach_m = 0.0;  // 0: none
    double radius_m = 0.05;
    double max_mass_kg = 20.0;
    double force_n = 40.0;
    double speed_mps = 2.5;
};

// How the palm that is shown keeps to the surface it grips.
struct PalmTuning {
    double min_height_m = 0.001;
    double max_height_m = 0.015;
    double max_angle_rad = 0.44;
    double tilt_cost_m_per_rad = 0.08;
    double rotation_arm_m = 0.025;
    double backface_cost_m = 0.02;
    double reach_m = 0.12;
    std::int32_t evaluations_per_frame = 1;
    double normal_radius_m = 0.03;
    double rate_mps = 0.25;
    double lift_m = 0.005;
    double lift_from_depth_m = 0.0015;
};

// How fingers close.
struct FingerTuning {
    double plane_offset = 0.62;
    double search_depth_m = 1.2e-3;
    double open_depth_m = 8e-4;
    double open_step_rad = 0.0436;
    std::int32_t open_steps = 6;
    double close_radps = 9.42;
    double transition_radps = 15.0;
    double slow_speed_mps = 0.05;
    double fast_refit_depth_m = 2e-3;
    double reuse_travel_m = 1e-6;
    std::int32_t refits_per_frame = 2;
};

struct ThumbTuning {
    std::int32_t opposition_steps = 6;
    std::int32_t evaluations_per_frame = 2;
    double rest_opposition_rad = 0.26;
    double penetration_cost = 4.0;
    double open_cost_m = 0.012;
    double tip_gap_cost = 0.5;
    double opposition_cost_m_per_rad = 0.004;
};

struct HeadTuning {
    double radius_m = 0.11;
    Vec3 center_m = Vec3(0.0, 0.0, 0.05);  // of the collider, in the tracked head's frame
    double restitution = 0.2;
    double friction = 0.0;
};

enum class SupportFollow : std::int32_t { off = 0, yaw = 1, full = 2 };

struct LocomotionTuning {
    double release_speed_max_mps = 6.0;
    double object_speed_max_mps = 12.0;
    double object_spin_max_radps = 200.0;
    double drift_drag_per_s = 0.02;
    double brake_drag_per_s = 3.0;
    double smooth_turn_radps = 1.5;
    double snap_turn_rad = 0.5235987755982988;
    double thruster_mps2 = 0.0;  // 0: no thrusters
    SupportFollow support_follow = SupportFollow::off;
};

struct PhaseTuning {
    double kappa_light_kg = 100.0;   // below: holding it never moves the player
    double kappa_heavy_kg = 1000.0;  // from here on: momentum is exchanged exactly
    double heavy_body_kg =
        1000.0;  // from here on: gripped like a wall, unmoved by the forward phase
};

struct ContactTuning {
    double margin_m = 0.02;
    double sweep_m = 0.005;
    double restitution_speed_mps = 0.2;
    std::int32_t max_rounds = 4;
    double restore_depth_m = 1e-4;  // what stays sunk deeper is put back
};

struct SolverTuning {
    std::int32_t max_iterations = 30;
    double tolerance_m = 1e-7;
    double step_tolerance_m = 1e-9;
    // Relative to the system's diagonal; hands soften and harden from here as the error falls.
    double drive_regularisation = 1e-8;
    double forward_drive_regularisation = 1e-3;
    double contact_regularisation = 1e-7;
    double joint_regularisation = 1e-10;
    // How far they do, and how fast (engine/solver/newton/regularisation.hpp).
    double max_drive_regularisation = 1e-2;
    double min_drive_regularisation = 1e-9;
    double max_contact_regularisation = 1e-3;
    double regularisation_decrease = 0.03;
    double regularisation_increase = 10.0;
    std::int32_t linear_decrease_steps = 3;
    double linear_decrease_ratio = 0.95;
    double max_step_rotation_rad = 1.0;
    double min_step_scale = 0.3;
    double geometric_stiffness_from_m = 1e-4;
    double load_stepping_from_m = 0.05;
    std::int32_t friction_passes = 16;
};

struct Tuning {
    TrackingTuning tracking;
    HandTuning hand;
    PalmTuning palm;
    FingerTuning finger;
    ThumbTuning thumb;
    HeadTuning head;
    LocomotionTuning locomotion;
    PhaseTuning phases;
    ContactTuning contact;
    SolverTuning solver;
    ArmTuning arm;
    CalibrationTuning calibration;
    SpineTuning spine;
    AdditiveTuning additive;
    PullTuning pull;
};

// What is known of one number beside its value.
struct TuningInfo {
    const char* name;  // "hand.reach_m": as in files
    const char* unit;  // "m", "1/s", "" for none
    double low;        // inclusive range
    double high;
    const char* what;
};

// Calls visit(info, field) for every number; fields are double, std::int32_t, Vec3 (each component
// in the range) or SupportFollow.
template <typename TuningType, typename Visit>
void visit_tuning(TuningType& t, Visit&& visit) {
    const auto see = [&visit](const char* name, auto& field, const char* unit, double low,
                              double high, const char* what) {
        visit(TuningInfo{name, unit, low, high, what}, field);
    };
    see("tracking.lost_after_s", t.tracking.lost_after_s, "s", 0.02, 10.0,
        "a device silent or invalid for longer counts as lost");
    see("tracking.max_jump_m", t.tracking.max_jump_m, "m", 0.1, 1000.0,
        "a head that is farther from one sample to the next has been re-centred: nobody moves");
    see("tracking.release_window_s", t.tracking.release_window_s, "s", 0.01, 0.5,
        "span before letting go over which the hand's velocity is measured");
    see("tracking.max_hand_speed_mps", t.tracking.max_hand_speed_mps, "m/s", 0.5, 1e6,
        "a hand reading that implies a faster hand is ignored until later readings confirm it; a "
        "gripping hand never moves the view faster");
    see("hand.controller_offset_m", t.hand.controller_offset_m, "m", -0.5, 0.5,
        "wrist in the controller's frame, right hand (x mirrored for the left)");
    see("hand.controller_pitch_rad", t.hand.controller_pitch_rad, "rad", -3.2, 3.2,
        "hand against controller about the controller's x, positive lifts the fingers");
    see("hand.palm_center_m", t.hand.palm_center_m, "m", -0.5, 0.5,
        "skin of the palm in the hand's frame");
    see("hand.ray_back_m", t.hand.ray_back_m, "m", 0.0, 0.2,
        "the palm's ray starts this far behind the palm");
    see("hand.ray_length_m", t.hand.ray_length_m, "m", 0.01, 2.0, "length of the palm's ray");
    see("hand.reach_m", t.hand.reach_m, "m", 0.0, 1.0,
        "where the ray misses, the nearest surface up to this far from the palm is gripped");
    see("hand.max_stretch_m", t.hand.max_stretch_m, "m", 0.01, 10.0,
        "a hand farther than this from its anchor lets go");
    see("hand.max_arm_m", t.hand.max_arm_m, "m", 0.5, 1000.0,
        "a hand that is said to be farther than this from its head is not believed");
    see("hand.return_speed_mps", t.hand.return_speed_mps, "m/s", 0.0, 100.0,
        "a held body that a tracking jump left behind comes back to its hand at this speed");
    see("palm.min_height_m", t.palm.min_height_m, "m", -0.05, 0.1,
        "a gripping palm is shown at least this high over the surface");
    see("palm.max_height_m", t.palm.max_height_m, "m", -0.05, 0.2,
        "and at most this high; where that is less, palm.min_height_m counts");
    see("palm.max_angle_rad", t.palm.max_angle_rad, "rad", 0.0, 3.2,
        "and tilted against the surface by at most this");
    see("palm.tilt_cost_m_per_rad", t.palm.tilt_cost_m_per_rad, "m/rad", 0.0, 10.0,
        "what tilting the palm counts against moving it when a surface is chosen");
    see("palm.rotation_arm_m", t.palm.rotation_arm_m, "m", 1e-3, 10.0,
        "what turning it by a radian counts against moving it where it is pushed out of what it is "
        "sunk in");
    see("palm.backface_cost_m", t.palm.backface_cost_m, "m", 0.0, 1.0,
        "what a surface whose outside is turned away from the palm counts more");
    see("palm.reach_m", t.palm.reach_m, "m", 0.0, 1.0,
        "surfaces farther from the palm than this are not looked at");
    see("palm.evaluations_per_frame", t.palm.evaluations_per_frame, "", 1.0, 14.0,
        "surfaces that are tried in one frame, the cheapest first, until no other would cost less");
    see("palm.normal_radius_m", t.palm.normal_radius_m, "m", 1e-3, 0.2,
        "the palm lies against the mean of the surface within this");
    see("palm.rate_mps", t.palm.rate_mps, "m/s", 0.0, 1e6,
        "how fast the hand that is shown leaves or joins the tracked one");
    see("palm.lift_m", t.palm.lift_m, "m", 0.0, 0.1,
        "a hand whose fingers do not fit is lifted by this, at most three times");
    see("palm.lift_from_depth_m", t.palm.lift_from_depth_m, "m", 0.0, 0.1,
        "fingers that are sunk deeper lift the hand");
    see("finger.plane_offset", t.finger.plane_offset, "", 0.0, 0.99,
        "outer planes of a finger from its middle, in its radius");
    see("finger.search_depth_m", t.finger.search_depth_m, "m", 0.0, 0.1,
        "a finger sunk deeper looks at every surface within its reach, and in a slow hand for "
        "another fit");
    see("finger.open_depth_m", t.finger.open_depth_m, "m", 0.0, 0.1,
        "a finger that is still sunk deeper opens");
    see("finger.open_step_rad", t.finger.open_step_rad, "rad", 1e-3, 1.0, "by this at a time");
    see("finger.open_steps", t.finger.open_steps, "", 0.0, 64.0, "and at most so often");
    see("finger.close_radps", t.finger.close_radps, "rad/s", 0.0, 1e6,
        "fingers are shown closing no faster; they open at once,");
    see("finger.transition_radps", t.finger.transition_radps, "rad/s", 0.1, 1e6,
        "but no faster where a digit of a sliding hand changes from one fit to another");
    see("finger.slow_speed_mps", t.finger.slow_speed_mps, "m/s", 0.0, 10.0,
        "a hand that slides no faster may change to fits that would not last in a fast one");
    see("finger.fast_refit_depth_m", t.finger.fast_refit_depth_m, "m", 0.0, 0.1,
        "a digit of a faster hand looks for another fit where it is sunk deeper");
    see("finger.reuse_travel_m", t.finger.reuse_travel_m, "m", 0.0, 0.01,
        "a hand that moved less on its surface keeps its fingers");
    see("finger.refits_per_frame", t.finger.refits_per_frame, "", 1.0, 5.0,
        "fingers of a hand that are closed anew in one frame; the others have their turn later");
    see("thumb.opposition_steps", t.thumb.opposition_steps, "", 1.0, 32.0,
        "angles of opposition that are tried");
    see("thumb.evaluations_per_frame", t.thumb.evaluations_per_frame, "", 1.0, 32.0,
        "of these in one frame");
    see("thumb.rest_opposition_rad", t.thumb.rest_opposition_rad, "rad", -3.2, 3.2,
        "opposition of a thumb at ease");
    see("thumb.penetration_cost", t.thumb.penetration_cost, "", 0.0, 1e3,
        "a thumb's cost per depth");
    see("thumb.open_cost_m", t.thumb.open_cost_m, "m", 0.0, 1.0,
        "a thumb's cost where it touches nothing");
    see("thumb.tip_gap_cost", t.thumb.tip_gap_cost, "", 0.0, 1e3,
        "a thumb's cost per distance of its tip from the surface");
    see("thumb.opposition_cost_m_per_rad", t.thumb.opposition_cost_m_per_rad, "m/rad", 0.0, 10.0,
        "a thumb's cost per angle of opposition away from rest");
    see("head.radius_m", t.head.radius_m, "m", 0.02, 0.5, "radius of the head's collider");
    see("head.center_m", t.head.center_m, "m", -0.5, 0.5,
        "centre of the head's collider in the tracked head's frame");
    see("head.restitution", t.head.restitution, "", 0.0, 1.0,
        "bounce of a drifting head off a wall");
    see("head.friction", t.head.friction, "", 0.0, 10.0,
        "Coulomb's coefficient of the head; 0: it glides along walls");
    see("locomotion.release_speed_max_mps", t.locomotion.release_speed_max_mps, "m/s", 0.0, 1e6,
        "a player who lets go or is pushed leaves at most this fast, against the reference "
        "velocity");
    see("locomotion.object_speed_max_mps", t.locomotion.object_speed_max_mps, "m/s", 0.0, 1e6,
        "a thrown object leaves at most this fast, against the reference velocity");
    see("locomotion.object_spin_max_radps", t.locomotion.object_spin_max_radps, "rad/s", 0.0, 1e3,
        "nothing that moves freely spins faster");
    see("locomotion.drift_drag_per_s", t.locomotion.drift_drag_per_s, "1/s", 0.0, 100.0,
        "drag of a drifting player, against the reference velocity");
    see("locomotion.brake_drag_per_s", t.locomotion.brake_drag_per_s, "1/s", 0.0, 100.0,
        "drag with the brake fully pressed");
    see("locomotion.smooth_turn_radps", t.locomotion.smooth_turn_radps, "rad/s", 0.0, 20.0,
        "turning speed with the stick fully pressed");
    see("locomotion.snap_turn_rad", t.locomotion.snap_turn_rad, "rad", 0.0, 3.2,
        "angle of one snap turn");
    see("locomotion.thruster_mps2", t.locomotion.thruster_mps2, "m/s^2", 0.0, 100.0,
        "acceleration of the wrist thrusters; 0: none");
    see("locomotion.support_follow", t.locomotion.support_follow, "", 0.0, 2.0,
        "play space turns with what is gripped: 0 off, 1 in yaw, 2 fully");
    see("phases.kappa_light_kg", t.phases.kappa_light_kg, "kg", 0.0, 1e9,
        "an object lighter than this never moves the player who holds it in free space");
    see("phases.kappa_heavy_kg", t.phases.kappa_heavy_kg, "kg", 1e-6, 1e9,
        "from this mass on, momentum is exchanged exactly; above kappa_light_kg");
    see("phases.heavy_body_kg", t.phases.heavy_body_kg, "kg", 1e-6, 1e9,
        "from this mass on a free body is gripped like a wall");
    see("contact.margin_m", t.contact.margin_m, "m", 1e-3, 0.2,
        "contacts are made up to this far ahead");
    see("contact.sweep_m", t.contact.sweep_m, "m", 1e-4, 0.1,
        "colliders that move farther in a frame are swept");
    see("contact.restitution_speed_mps", t.contact.restitution_speed_mps, "m/s", 0.0, 100.0,
        "slower impacts do not bounce");
    see("contact.max_rounds", t.contact.max_rounds, "", 1.0, 16.0,
        "times that a phase is solved again with contacts found on its result");
    see("contact.restore_depth_m", t.contact.restore_depth_m, "m", 1e-6, 10.0,
        "free bodies that no phase takes out of a deeper overlap stay where they were");
    see("solver.max_iterations", t.solver.max_iterations, "", 1.0, 1000.0,
        "Newton iterations a phase; five times as many at most where hands are led");
    see("solver.tolerance_m", t.solver.tolerance_m, "m", 1e-12, 1e-3,
        "constraint error at which a phase is solved; angles count times 0.1 m");
    see("solver.step_tolerance_m", t.solver.step_tolerance_m, "m", 1e-14, 1e-3,
        "a smaller Newton step ends a phase");
    see("solver.drive_regularisation", t.solver.drive_regularisation, "", 1e-9, 1e-2,
        "how much hands give way at first, but in the forward phase");
    see("solver.forward_drive_regularisation", t.solver.forward_drive_regularisation, "", 1e-9,
        1e-2, "how much hands give way at first in the forward phase, where contacts decide");
    see("solver.contact_regularisation", t.solver.contact_regularisation, "", 1e-12, 1e-3,
        "how much contacts give way that cannot all be met");
    see("solver.joint_regularisation", t.solver.joint_regularisation, "", 1e-14, 1e-3,
        "how much joints give way that cannot all be met; their limits a hundred times");
    see("solver.max_drive_regularisation", t.solver.max_drive_regularisation, "", 1e-9, 1.0,
        "how much hands give way at most, where the error does not fall; no less than "
        "solver.min_drive_regularisation");
    see("solver.min_drive_regularisation", t.solver.min_drive_regularisation, "", 1e-12, 1e-2,
        "how much hands give way at least, where the error falls");
    see("solver.max_contact_regularisation", t.solver.max_contact_regularisation, "", 1e-12, 1e-2,
        "how much contacts that contradict each other give way at most; no less than "
        "solver.contact_regularisation");
    see("solver.regularisation_decrease", t.solver.regularisation_decrease, "", 1e-6, 1.0,
        "times the regularisation of hands after a step that takes the error down");
    see("solver.regularisation_increase", t.solver.regularisation_increase, "", 1.0, 1e6,
        "times the regularisation of hands after a step that does not");
    see("solver.linear_decrease_steps", t.solver.linear_decrease_steps, "", 1.0, 1000.0,
        "whole steps in a row that let the error fall slowly count as one that takes it down");
    see("solver.linear_decrease_ratio", t.solver.linear_decrease_ratio, "", 0.0, 1.0,
        "of the error, which such a step leaves at most");
    see("solver.max_step_rotation_rad", t.solver.max_step_rotation_rad, "rad", 1e-3, 3.0,
        "of a body in a Newton step; farther ones are scaled down");
    see("solver.min_step_scale", t.solver.min_step_scale, "", 0.0, 1.0,
        "steps scaled down further are tried again with everything softer");
    see("solver.geometric_stiffness_from_m", t.solver.geometric_stiffness_from_m, "m", 1e-9, 10.0,
        "constraint error above which steps account for how forces turn with their arms");
    see("solver.load_stepping_from_m", t.solver.load_stepping_from_m, "m", 0.0, 1e6,
        "hands that a phase's iterations took so much nearer, but not there, are led part by part");
    see("solver.friction_passes", t.solver.friction_passes, "", 1.0, 100.0,
        "solves at most to find who sticks and who slides");
    visit_body_tuning(t, see);
    see("pull.reach_m", t.pull.reach_m, "m", 0.0, 20.0,
        "distance grab: what is this far before a closing empty palm is pulled; 0: none");
    see("pull.radius_m", t.pull.radius_m, "m", 0.001, 0.5,
        "radius of the sphere that is sent along the palm's ray to find it");
    see("pull.max_mass_kg", t.pull.max_mass_kg, "kg", 0.0, 1e6, "heavier bodies stay");
    see("pull.force_n", t.pull.force_n, "N", 0.0, 1e6,
        "greatest force between the body and the player");
    see("pull.speed_mps", t.pull.speed_mps, "m/s", 0.1, 100.0,
        "greatest speed towards the hand that it is pulled to");
}

}  // namespace handhold
