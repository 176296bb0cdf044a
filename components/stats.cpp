#include "components/stats.hpp"

#include "engine/core/enum_texts.hpp"

namespace handhold {
namespace {

constexpr EnumTexts<Stage> k_stages = {{
    {Stage::read_tracking, "read_tracking"},
    {Stage::calibrate_players, "calibrate_players"},
    {Stage::group_joints, "group_joints"},
    {Stage::update_grabs, "update_grabs"},
    {Stage::locomote_players, "locomote_players"},
    {Stage::animate_movers, "animate_movers"},
    {Stage::predict_bodies, "predict_bodies"},
    {Stage::anchor_grabs, "anchor_grabs"},
    {Stage::find_contacts, "find_contacts"},
    {Stage::build_constraints, "build_constraints"},
    {Stage::solve_phases, "solve_phases"},
    {Stage::solve_velocities, "solve_velocities"},
    {Stage::book_momentum, "book_momentum"},
    {Stage::record_valid_poses, "record_valid_poses"},
    {Stage::update_joints, "update_joints"},
    {Stage::gather_surroundings, "gather_surroundings"},
    {Stage::search_grip, "search_grip"},
    {Stage::constrain_palms, "constrain_palms"},
    {Stage::sweep_fingers, "sweep_fingers"},
    {Stage::fit_hands, "fit_hands"},
    {Stage::estimate_arms, "estimate_arms"},
    {Stage::pose_arms, "pose_arms"},
    {Stage::propagate_spine, "propagate_spine"},
    {Stage::layer_additives, "layer_additives"},
    {Stage::publish_pose, "publish_pose"},
}};
static_assert(is_in_order(k_stages));

constexpr EnumTexts<Fallback> k_fallbacks = {{
    {Fallback::sample_out_of_order, "sample_out_of_order"},
    {Fallback::sample_not_finite, "sample_not_finite"},
    {Fallback::tracking_lost, "tracking_lost"},
    {Fallback::hand_out_of_reach, "hand_out_of_reach"},
    {Fallback::head_recentred, "head_recentred"},
    {Fallback::device_asleep, "device_asleep"},
    {Fallback::hand_implausible, "hand_implausible"},
    {Fallback::space_recentred, "space_recentred"},
    {Fallback::sample_too_far_ahead, "sample_too_far_ahead"},
    {Fallback::sample_too_old, "sample_too_old"},
    {Fallback::grab_no_surface, "grab_no_surface"},
    {Fallback::grip_stretched, "grip_stretched"},
    {Fallback::grip_lost, "grip_lost"},
    {Fallback::grip_body_gone, "grip_body_gone"},
    {Fallback::grip_reanchored, "grip_reanchored"},
    {Fallback::two_hand_grip_ended, "two_hand_grip_ended"},
    {Fallback::hands_too_close, "hands_too_close"},
    {Fallback::grab_refused_by_rule, "grab_refused_by_rule"},
    {Fallback::grab_needs_two_hands, "grab_needs_two_hands"},
    {Fallback::grip_needs_two_hands, "grip_needs_two_hands"},
    {Fallback::grip_ended_by_host, "grip_ended_by_host"},
    {Fallback::grip_out_of_reach, "grip_out_of_reach"},
    {Fallback::grip_speed_limited, "grip_speed_limited"},
    {Fallback::grab_out_of_sight, "grab_out_of_sight"},
    {Fallback::contact_rounds_exhausted, "contact_rounds_exhausted"},
    {Fallback::contacts_contradict, "contacts_contradict"},
    {Fallback::contacts_unresolved, "contacts_unresolved"},
    {Fallback::restored_last_valid_pose, "restored_last_valid_pose"},
    {Fallback::active_set_not_converged, "active_set_not_converged"},
    {Fallback::hands_load_stepped, "hands_load_stepped"},
    {Fallback::load_stepping_failed, "load_stepping_failed"},
    {Fallback::friction_not_converged, "friction_not_converged"},
    {Fallback::solver_budget, "solver_budget"},
    {Fallback::pairs_deferred, "pairs_deferred"},
    {Fallback::release_speed_clamped, "release_speed_clamped"},
    {Fallback::object_speed_clamped, "object_speed_clamped"},
    {Fallback::head_ignores_full, "head_ignores_full"},
    {Fallback::finger_full_search, "finger_full_search"},
    {Fallback::finger_depenetrated, "finger_depenetrated"},
    {Fallback::finger_opened, "finger_opened"},
    {Fallback::finger_no_contact, "finger_no_contact"},
    {Fallback::hand_penetrates, "hand_penetrates"},
    {Fallback::body_no_surface, "body_no_surface"},
    {Fallback::palm_no_surface, "palm_no_surface"},
    {Fallback::authored_grip_occupied, "authored_grip_occupied"},
    {Fallback::authored_grip_blocked, "authored_grip_blocked"},
    {Fallback::authored_grip_abandoned, "authored_grip_abandoned"},
    {Fallback::authored_finger_rejected, "authored_finger_rejected"},
    {Fallback::pull_refused_fixed, "pull_refused_fixed"},
    {Fallback::pull_refused_heavy, "pull_refused_heavy"},
    {Fallback::pull_refused_held, "pull_refused_held"},
    {Fallback::pull_lost, "pull_lost"},
    {Fallback::surface_answer_invalid, "surface_answer_invalid"},
}};
static_assert(is_in_order(k_fallbacks));

}  // namespace

const char* name_of(Stage stage) { return text_of(k_stages, stage); }
const char* name_of(Fallback reason) { return text_of(k_fallbacks, reason); }

}  // namespace handhold
