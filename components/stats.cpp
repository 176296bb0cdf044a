#include "components/stats.hpp"

namespace handhold {

const char* name_of(Stage stage) {
    switch (stage) {
        case Stage::read_tracking:
            return "read_tracking";
        case Stage::calibrate_players:
            return "calibrate_players";
        case Stage::group_joints:
            return "group_joints";
        case Stage::update_grabs:
            return "update_grabs";
        case Stage::locomote_players:
            return "locomote_players";
        case Stage::animate_movers:
            return "animate_movers";
        case Stage::predict_bodies:
            return "predict_bodies";
        case Stage::anchor_grabs:
            return "anchor_grabs";
        case Stage::find_contacts:
            return "find_contacts";
        case Stage::build_constraints:
            return "build_constraints";
        case Stage::solve_phases:
            return "solve_phases";
        case Stage::update_velocities:
            return "update_velocities";
        case Stage::update_joints:
            return "update_joints";
        case Stage::gather_surroundings:
            return "gather_surroundings";
        case Stage::search_grip:
            return "search_grip";
        case Stage::constrain_palms:
            return "constrain_palms";
        case Stage::sweep_fingers:
            return "sweep_fingers";
        case Stage::fit_hands:
            return "fit_hands";
        case Stage::estimate_arms:
            return "estimate_arms";
        case Stage::pose_arms:
            return "pose_arms";
        case Stage::propagate_spine:
            return "propagate_spine";
        case Stage::layer_additives:
            return "layer_additives";
        case Stage::publish_pose:
            return "publish_pose";
        case Stage::count:
            break;
    }
    return "unknown";
}

const char* name_of(Fallback reason) {
    switch (reason) {
        case Fallback::sample_out_of_order:
            return "sample_out_of_order";
        case Fallback::sample_not_finite:
            return "sample_not_finite";
        case Fallback::tracking_lost:
            return "tracking_lost";
        case Fallback::hand_out_of_reach:
            return "hand_out_of_reach";
        case Fallback::head_recentred:
            return "head_recentred";
        case Fallback::device_asleep:
            return "device_asleep";
        case Fallback::hand_implausible:
            return "hand_implausible";
        case Fallback::space_recentred:
            return "space_recentred";
        case Fallback::grab_no_surface:
            return "grab_no_surface";
        case Fallback::grip_stretched:
            return "grip_stretched";
        case Fallback::grip_lost:
            return "grip_lost";
        case Fallback::grip_body_gone:
            return "grip_body_gone";
        case Fallback::grip_reanchored:
            return "grip_reanchored";
        case Fallback::two_hand_grip_ended:
            return "two_hand_grip_ended";
        case Fallback::hands_too_close:
            return "hands_too_close";
        case Fallback::grab_refused_by_rule:
            return "grab_refused_by_rule";
        case Fallback::grab_needs_two_hands:
            return "grab_needs_two_hands";
        case Fallback::grip_needs_two_hands:
            return "grip_needs_two_hands";
        case Fallback::grip_ended_by_host:
            return "grip_ended_by_host";
        case Fallback::grip_out_of_reach:
            return "grip_out_of_reach";
        case Fallback::grip_speed_limited:
            return "grip_speed_limited";
        case Fallback::grab_out_of_sight:
            return "grab_out_of_sight";
        case Fallback::contact_rounds_exhausted:
            return "contact_rounds_exhausted";
        case Fallback::contacts_contradict:
            return "contacts_contradict";
        case Fallback::contacts_unresolved:
            return "contacts_unresolved";
        case Fallback::restored_last_valid_pose:
            return "restored_last_valid_pose";
        case Fallback::active_set_not_converged:
            return "active_set_not_converged";
        case Fallback::hands_load_stepped:
            return "hands_load_stepped";
        case Fallback::load_stepping_failed:
            return "load_stepping_failed";
        case Fallback::friction_not_converged:
            return "friction_not_converged";
        case Fallback::solver_budget:
            return "solver_budget";
        case Fallback::release_speed_clamped:
            return "release_speed_clamped";
        case Fallback::object_speed_clamped:
            return "object_speed_clamped";
        case Fallback::head_ignores_full:
            return "head_ignores_full";
        case Fallback::finger_full_search:
            return "finger_full_search";
        case Fallback::finger_depenetrated:
            return "finger_depenetrated";
        case Fallback::finger_opened:
            return "finger_opened";
        case Fallback::finger_no_contact:
            return "finger_no_contact";
        case Fallback::hand_penetrates:
            return "hand_penetrates";
        case Fallback::body_no_surface:
            return "body_no_surface";
        case Fallback::palm_no_surface:
            return "palm_no_surface";
        case Fallback::authored_grip_occupied:
            return "authored_grip_occupied";
        case Fallback::authored_grip_blocked:
            return "authored_grip_blocked";
        case Fallback::authored_grip_abandoned:
            return "authored_grip_abandoned";
        case Fallback::authored_finger_rejected:
            return "authored_finger_rejected";
        case Fallback::pull_refused_fixed:
            return "pull_refused_fixed";
        case Fallback::pull_refused_heavy:
            return "pull_refused_heavy";
        case Fallback::pull_refused_held:
            return "pull_refused_held";
        case Fallback::pull_lost:
            return "pull_lost";
        case Fallback::surface_answer_invalid:
            return "surface_answer_invalid";
        case Fallback::count:
            break;
    }
    return "unknown";
}

}  // namespace handhold
