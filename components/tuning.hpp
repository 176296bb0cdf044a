#pragma once

#include <cstdint>
#include <string_view>

#include "components/body_tuning.hpp"
#include "engine/math/math.hpp"
#include "engine/solver/newton/settings.hpp"

// Every tunable number with its default. visit_tuning describes each number once, with unit and
// range. Tuning files, the report and the inspector use these descriptions.
namespace handhold {

struct TrackingTuning {
    double lost_after_s = 0.25;
    double max_jump_m = 2.0;
    double release_window_s = 0.06;
    double max_hand_speed_mps = 8.0;
};

struct HandTuning {
    Vec3 controller_offset_m = Vec3(0.0, 0.0, 0.09);  // right hand
    double controller_pitch_rad = -0.35;
    Vec3 palm_center_m = Vec3(0.0, -0.014, -0.08);  // point in hand space
    double ray_back_m = 0.03;
    double ray_length_m = 0.15;
    double reach_m = 0.10;
    double max_stretch_m = 0.3;
    double max_arm_m = 2.0;
    double return_speed_mps = 2.0;
    double part_speed_mps = 2.0;
    double swing_lag_s = 0.2;
};

// Distance grab: a hand that closes without gripping anything pulls the free body at which its palm
// points.
struct PullTuning {
    double reach_m = 0.0;  // 0: off
    double radius_m = 0.05;
    double max_mass_kg = 20.0;
    double force_n = 40.0;
    double speed_mps = 2.5;
};

// How a surface is chosen for a gripping palm, and how the palm is fitted to it.
struct PalmTuning {
    double min_height_m = 0.001;
    double max_height_m = 0.015;
    double max_angle_rad = 0.44;
    double tilt_cost_m_per_rad = 0.08;
    double rotation_arm_m = 0.025;
    double backface_cost_m = 0.02;
    double reach_m = 0.12;
    double normal_radius_m = 0.03;
    double rate_mps = 0.25;
};

// How fingers close on a surface.
struct FingerTuning {
    double plane_offset = 0.62;
    double search_depth_m = 1.2e-3;
    double open_depth_m = 8e-4;
    double open_step_rad = 0.0436;
    std::int32_t open_steps = 6;
    double close_radps = 9.42;
    double open_radps = 15.0;
    double reuse_travel_m = 1e-6;
};

// How a thumb's opposition is chosen: the fit of lowest cost.
struct ThumbTuning {
    std::int32_t opposition_steps = 6;
    double rest_opposition_rad = 0.26;
    double penetration_cost = 4.0;
    double open_cost_m = 0.012;
    double tip_gap_cost = 0.5;
    double opposition_cost_m_per_rad = 0.004;
};

struct HeadTuning {
    double radius_m = 0.11;
    Vec3 center_m = Vec3(0.0, 0.0, 0.05);  // point in the tracked head's frame
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
    double kappa_light_kg = 100.0;
    double kappa_heavy_kg = 1000.0;
    double heavy_body_kg = 1000.0;
};

struct ContactTuning {
    double margin_m = 0.02;
    double sweep_m = 0.005;
    double restitution_speed_mps = VelocitySettings{}.restitution_speed_mps;
    std::int32_t max_rounds = 4;
    double restore_depth_m = 1e-4;
};

struct SolverTuning {
    NewtonSettings positions;  // settings of solve_positions
    // Replaces positions.regularisation.drive in the forward phase, in which hands must yield to
    // contacts.
    double forward_drive_regularisation = 1e-3;
    std::int32_t friction_passes = VelocitySettings{}.friction_passes;
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

// Description of one tunable number.
struct TuningInfo {
    const char* name;  // "group.field" as in tuning files, e.g. "hand.reach_m"
    const char* unit;  // "m", "1/s"; "" if dimensionless
    double low;        // inclusive
    double high;       // inclusive
    const char* what;  // meaning and effect, one sentence that stands alone
    bool scales;       // times PlayerOrigin::scale for a player of another size
};

// True if a number of the tuning scales with the player: its unit begins with metres, or is
// newtons. Numbers of contacts and of the solver belong to the world and do not scale.
constexpr bool is_in_players_metres(std::string_view name, std::string_view unit) {
    return (unit.starts_with("m") || unit == "N") && !name.starts_with("contact.") &&
           !name.starts_with("solver.");
}

// Calls visit(info, field) for every number. A field is a double, a std::int32_t, a Vec3 (the range
// applies to each component) or a SupportFollow.
template <typename TuningType, typename Visit>
void visit_tuning(TuningType& t, Visit&& visit) {
    const auto see = [&visit](const char* name, auto& field, const char* unit, double low,
                              double high, const char* what) {
        visit(TuningInfo{name, unit, low, high, what, is_in_players_metres(name, unit)}, field);
    };
    see("tracking.lost_after_s", t.tracking.lost_after_s, "s", 0.02, 10.0,
        "Time without a valid sample after which a device counts as lost and its pose is frozen.");
    see("tracking.max_jump_m", t.tracking.max_jump_m, "m", 0.1, 1000.0,
        "Head movement between two samples above which the headset counts as re-centred: the "
        "player stays in place.");
    see("tracking.release_window_s", t.tracking.release_window_s, "s", 0.01, 0.5,
        "Time before a release over which the hand's throwing velocity is measured.");
    see("tracking.max_hand_speed_mps", t.tracking.max_hand_speed_mps, "m/s", 0.5, 1e6,
        "Hand speed above which a sample is ignored until later samples confirm it; a gripping "
        "hand moves its player no faster.");
    see("hand.controller_offset_m", t.hand.controller_offset_m, "m", -0.5, 0.5,
        "Wrist position in the controller's frame for the right hand; x is mirrored for the left.");
    see("hand.controller_pitch_rad", t.hand.controller_pitch_rad, "rad", -3.2, 3.2,
        "Hand pitch in the controller's frame about its x axis; positive raises the fingers.");
    see("hand.palm_center_m", t.hand.palm_center_m, "m", -0.5, 0.5,
        "Point on the palm's skin in hand space from which the palm ray and reach are measured.");
    see("hand.ray_back_m", t.hand.ray_back_m, "m", 0.0, 0.2,
        "Distance behind the palm, towards the back of the hand, at which the palm ray starts.");
    see("hand.ray_length_m", t.hand.ray_length_m, "m", 0.01, 2.0,
        "Length of the palm ray that finds what a closing hand grabs.");
    see("hand.reach_m", t.hand.reach_m, "m", 0.0, 1.0,
        "If the palm ray hits nothing, the nearest surface within this distance of the palm is "
        "gripped.");
    see("hand.max_stretch_m", t.hand.max_stretch_m, "m", 0.01, 10.0,
        "Distance between a hand and its anchor above which the hand lets go.");
    see("hand.max_arm_m", t.hand.max_arm_m, "m", 0.5, 1000.0,
        "Distance from the head above which a hand sample is ignored as a tracking error.");
    see("hand.return_speed_mps", t.hand.return_speed_mps, "m/s", 0.0, 100.0,
        "Speed at which a held body comes back to its hand after a tracking error.");
    see("hand.part_speed_mps", t.hand.part_speed_mps, "m/s", 0.0, 100.0,
        "Greatest speed at which a grip on another player's arm, trunk or leg follows that part, "
        "relative to the player. Limits how fast a jump of the estimated body moves both players.");
    see("hand.swing_lag_s", t.hand.swing_lag_s, "s", 0.0, 10.0,
        "Time constant with which a grip on another player's trunk or leg follows that "
        "part. Damps a feedback: the grip moves the gripped player, which makes the part swing.");
    see("palm.min_height_m", t.palm.min_height_m, "m", -0.05, 0.1,
        "Minimum height of a gripping palm's centre above its surface.");
    see("palm.max_height_m", t.palm.max_height_m, "m", -0.05, 0.2,
        "Maximum height of a gripping palm's centre above its surface; palm.min_height_m wins if "
        "it is larger.");
    see("palm.max_angle_rad", t.palm.max_angle_rad, "rad", 0.0, 3.2,
        "Maximum tilt of a gripping palm against its surface normal.");
    see("palm.tilt_cost_m_per_rad", t.palm.tilt_cost_m_per_rad, "m/rad", 0.0, 10.0,
        "Cost of tilting the palm by a radian, in metres of palm movement, when a surface is "
        "chosen.");
    see("palm.rotation_arm_m", t.palm.rotation_arm_m, "m", 1e-3, 10.0,
        "Lever arm that weighs rotation against translation when a palm is depenetrated; larger: "
        "it turns less.");
    see("palm.backface_cost_m", t.palm.backface_cost_m, "m", 0.0, 1.0,
        "Extra cost, in metres of palm movement, of a surface whose outside faces away from the "
        "palm.");
    see("palm.reach_m", t.palm.reach_m, "m", 0.0, 1.0,
        "Distance from the palm beyond which surfaces are not searched.");
    see("palm.normal_radius_m", t.palm.normal_radius_m, "m", 1e-3, 0.2,
        "Radius around the palm's surface point over which the surface normal is averaged.");
    see("palm.rate_mps", t.palm.rate_mps, "m/s", 0.0, 1e6,
        "Maximum speed at which the shown hand moves relative to the tracked hand.");
    see("finger.plane_offset", t.finger.plane_offset, "", 0.0, 0.99,
        "A closing finger is tested against cross-sections of the surface in three parallel "
        "planes. Distance of the outer two from the finger's middle plane, in mean link radii.");
    see("finger.search_depth_m", t.finger.search_depth_m, "m", 0.0, 0.1,
        "Penetration depth above which a closing finger tests every triangle in reach, and above "
        "which a finger does not take its authored pose.");
    see("finger.open_depth_m", t.finger.open_depth_m, "m", 0.0, 0.1,
        "Penetration depth above which a fitted finger is opened step by step.");
    see("finger.open_step_rad", t.finger.open_step_rad, "rad", 1e-3, 1.0,
        "Opening step while a finger is depenetrated.");
    see("finger.open_steps", t.finger.open_steps, "", 0.0, 64.0,
        "Maximum number of opening steps while a finger is depenetrated; 0: it is never opened.");
    see("finger.close_radps", t.finger.close_radps, "rad/s", 0.0, 1e6,
        "Speed at which shown fingers close, and at which a shown thumb turns.");
    see("finger.open_radps", t.finger.open_radps, "rad/s", 0.1, 1e6,
        "Speed at which shown fingers open.");
    see("finger.reuse_travel_m", t.finger.reuse_travel_m, "m", 0.0, 0.01,
        "Wrist travel since the last fit below which palm and fingers are fitted only until that "
        "fit has converged. Beyond it the fit is kept up to 1 mm, but not in authored grips.");
    see("thumb.opposition_steps", t.thumb.opposition_steps, "", 1.0, 32.0,
        "Number of evenly spaced opposition angles evaluated when a thumb is fitted.");
    see("thumb.rest_opposition_rad", t.thumb.rest_opposition_rad, "rad", -3.2, 3.2,
        "Opposition angle of a thumb in its rest pose.");
    see("thumb.penetration_cost", t.thumb.penetration_cost, "", 0.0, 1e3,
        "Cost of a thumb fit per metre of penetration or of overlap with fingers; other thumb "
        "costs are metres.");
    see("thumb.open_cost_m", t.thumb.open_cost_m, "m", 0.0, 1.0,
        "Cost of a thumb fit that touches nothing.");
    see("thumb.tip_gap_cost", t.thumb.tip_gap_cost, "", 0.0, 1e3,
        "Cost of a thumb fit per metre between its tip and the surface.");
    see("thumb.opposition_cost_m_per_rad", t.thumb.opposition_cost_m_per_rad, "m/rad", 0.0, 10.0,
        "Cost of a thumb fit per radian of opposition away from thumb.rest_opposition_rad.");
    see("head.radius_m", t.head.radius_m, "m", 0.02, 0.5, "Radius of the head's sphere collider.");
    see("head.center_m", t.head.center_m, "m", -0.5, 0.5,
        "Centre of the head's collider in the tracked head's frame.");
    see("head.restitution", t.head.restitution, "", 0.0, 1.0,
        "Restitution of a head that hits something, unless the other body's is larger; 0: no "
        "bounce, 1: full bounce.");
    see("head.friction", t.head.friction, "", 0.0, 10.0,
        "Coulomb friction coefficient of the head; 0: it slides freely along walls.");
    see("locomotion.release_speed_max_mps", t.locomotion.release_speed_max_mps, "m/s", 0.0, 1e6,
        "Maximum speed of a player after a release or push, relative to the reference velocity.");
    see("locomotion.object_speed_max_mps", t.locomotion.object_speed_max_mps, "m/s", 0.0, 1e6,
        "Maximum speed of a thrown, held or pushed object, relative to the reference velocity. A "
        "held or pushed object may keep a higher speed that it already had, or reach that of a "
        "kinematic or heavy body in its island.");
    see("locomotion.object_spin_max_radps", t.locomotion.object_spin_max_radps, "rad/s", 0.0, 1e3,
        "Maximum angular speed of a free body.");
    see("locomotion.drift_drag_per_s", t.locomotion.drift_drag_per_s, "1/s", 0.0, 100.0,
        "Drag rate of a drifting player's velocity relative to the reference velocity.");
    see("locomotion.brake_drag_per_s", t.locomotion.brake_drag_per_s, "1/s", 0.0, 100.0,
        "Drag rate with the brake fully pressed, of a player's velocity relative to the reference "
        "velocity; added to locomotion.drift_drag_per_s.");
    see("locomotion.smooth_turn_radps", t.locomotion.smooth_turn_radps, "rad/s", 0.0, 20.0,
        "Turning speed with the stick fully deflected.");
    see("locomotion.snap_turn_rad", t.locomotion.snap_turn_rad, "rad", 0.0, 3.2,
        "Angle of one snap turn.");
    see("locomotion.thruster_mps2", t.locomotion.thruster_mps2, "m/s^2", 0.0, 100.0,
        "Acceleration of the wrist thrusters; 0: no thrusters.");
    see("locomotion.support_follow", t.locomotion.support_follow, "", 0.0, 2.0,
        "Whether the play space turns with a gripped body: 0 no, 1 yaw only, 2 fully.");
    see("phases.kappa_light_kg", t.phases.kappa_light_kg, "kg", 0.0, 1e9,
        "Mass up to which a held free object moves the player only if it is pressed against "
        "something that cannot give way.");
    see("phases.kappa_heavy_kg", t.phases.kappa_heavy_kg, "kg", 1e-6, 1e9,
        "Mass from which a held object exchanges momentum with the player exactly; must exceed "
        "phases.kappa_light_kg.");
    see("phases.heavy_body_kg", t.phases.heavy_body_kg, "kg", 1e-6, 1e9,
        "Mass from which a free body is gripped like a wall and is held still in the forward "
        "phase, "
        "the solve that moves lighter free bodies.");
    see("contact.margin_m", t.contact.margin_m, "m", 1e-3, 0.2,
        "Distance up to which contacts are created before colliders touch.");
    see("contact.sweep_m", t.contact.sweep_m, "m", 1e-4, 0.1,
        "Collider movement per frame above which it is swept.");
    see("contact.restitution_speed_mps", t.contact.restitution_speed_mps, "m/s", 0.0, 100.0,
        "Impact speed below which bodies do not bounce.");
    see("contact.max_rounds", t.contact.max_rounds, "", 1.0, 16.0,
        "Maximum number of solves of a phase; it is solved again while contacts that are found at "
        "its result overlap.");
    see("contact.restore_depth_m", t.contact.restore_depth_m, "m", 1e-6, 10.0,
        "Overlap depth above which a free body that still overlaps after the solve is restored to "
        "its last valid pose.");
    see("solver.max_iterations", t.solver.positions.max_iterations, "", 1.0, 1000.0,
        "Maximum Newton iterations per phase; load stepping may use five times as many.");
    see("solver.tolerance_m", t.solver.positions.tolerance_m, "m", 1e-12, 1e-3,
        "Constraint error below which a phase is solved; angles count at a lever of 0.1 m.");
    see("solver.step_tolerance_m", t.solver.positions.step_tolerance_m, "m", 1e-14, 1e-3,
        "Newton step length below which a phase ends.");
    see("solver.drive_regularisation", t.solver.positions.regularisation.drive, "", 1e-9, 1e-2,
        "Initial relative regularisation of the hands' constraints in all phases but the forward "
        "phase; larger: hands yield more.");
    see("solver.forward_drive_regularisation", t.solver.forward_drive_regularisation, "", 1e-9,
        1e-2,
        "Initial relative regularisation of the hands' constraints in the forward phase, which "
        "solves contacts of free bodies; larger: hands yield more to contacts.");
    see("solver.contact_regularisation", t.solver.positions.regularisation.contact, "", 1e-12, 1e-3,
        "Relative regularisation of contacts; larger: conflicting contacts yield more.");
    see("solver.joint_regularisation", t.solver.positions.regularisation.joint, "", 1e-14, 1e-3,
        "Relative regularisation of joints; joint limits use 100 times as much.");
    see("solver.max_drive_regularisation", t.solver.positions.schedule.max_drive_regularisation, "",
        1e-9, 1.0,
        "Upper bound to which the hand regularisation rises while Newton steps do not reduce the "
        "error enough; at least solver.min_drive_regularisation.");
    see("solver.min_drive_regularisation", t.solver.positions.schedule.min_drive_regularisation, "",
        1e-12, 1e-2,
        "Lower bound to which the hand regularisation falls while Newton steps converge.");
    see("solver.max_contact_regularisation", t.solver.positions.schedule.max_contact_regularisation,
        "", 1e-12, 1e-2,
        "Upper bound of the contact regularisation while contacts conflict; at least "
        "solver.contact_regularisation.");
    see("solver.regularisation_decrease", t.solver.positions.schedule.regularisation_decrease, "",
        1e-6, 1.0,
        "Factor on the hand regularisation after a Newton step that halves the smallest error so "
        "far, or after solver.linear_decrease_steps slower ones.");
    see("solver.regularisation_increase", t.solver.positions.schedule.regularisation_increase, "",
        1.0, 1e6,
        "Factor on the hand regularisation after any Newton step to which "
        "solver.regularisation_decrease does not apply.");
    see("solver.linear_decrease_steps", t.solver.positions.schedule.linear_decrease_steps, "", 1.0,
        1000.0,
        "After this many consecutive Newton steps that each leave less than "
        "solver.linear_decrease_ratio of the error, the hand regularisation is reduced as after a "
        "step that halves it. Steps that were scaled down or have contacts do not count.");
    see("solver.linear_decrease_ratio", t.solver.positions.schedule.linear_decrease_ratio, "", 0.0,
        1.0,
        "A Newton step that leaves less than this share of the smallest error so far counts "
        "towards solver.linear_decrease_steps.");
    see("solver.max_step_rotation_rad", t.solver.positions.schedule.max_step_rotation_rad, "rad",
        1e-3, 3.0, "Maximum rotation of a body in one Newton step; larger steps are scaled down.");
    see("solver.min_step_scale", t.solver.positions.schedule.min_step_scale, "", 0.0, 1.0,
        "Step scale below which a Newton step is solved again with more regularisation.");
    see("solver.geometric_stiffness_from_m", t.solver.positions.geometric_stiffness_from_m, "m",
        1e-9, 10.0,
        "Constraint error above which Newton steps include geometric stiffness (forces turning "
        "with their levers).");
    see("solver.load_stepping_from_m", t.solver.positions.load_stepping_from_m, "m", 0.0, 1e6,
        "A solve that runs out of iterations after reducing the hands' error by more than this is "
        "repeated by load stepping: the hands' targets move in steps.");
    see("solver.friction_passes", t.solver.friction_passes, "", 1.0, 100.0,
        "Maximum number of velocity solves to decide which contacts stick and which slip.");
    visit_body_tuning(t, see);
    see("pull.reach_m", t.pull.reach_m, "m", 0.0, 20.0,
        "Distance grab: range of a closing empty hand along its palm ray; 0: distance grab is "
        "off.");
    see("pull.radius_m", t.pull.radius_m, "m", 0.001, 0.5,
        "Distance grab: radius of the sphere cast along the palm ray.");
    see("pull.max_mass_kg", t.pull.max_mass_kg, "kg", 0.0, 1e6,
        "Distance grab: mass above which a body is not pulled.");
    see("pull.force_n", t.pull.force_n, "N", 0.0, 1e6,
        "Distance grab: maximum force between the body and the player.");
    see("pull.speed_mps", t.pull.speed_mps, "m/s", 0.1, 100.0,
        "Distance grab: maximum speed of the body towards the hand.");
}

}  // namespace handhold
