#pragma once

#include "components/world.hpp"

// visit_fields for the components of hands and grips (see fields.hpp).
namespace handhold {

template <typename V>
void visit_fields(const AuthoredHand& c, V&& visit) {
    visit("is_there", c.is_there);
    visit("wrist_bs", c.wrist_bs);
    visit("is_posed", c.is_posed);
    visit("fingers", c.fingers);
    visit("follows_trigger", c.follows_trigger);
    visit("pressed", c.pressed);
}
template <typename V>
void visit_fields(const AuthoredGrip& c, V&& visit) {
    visit("hands", c.hands);
    visit("priority", c.priority);
    visit("snap_radius_m", c.snap_radius_m);
    visit("snap_angle_rad", c.snap_angle_rad);
}
template <typename V>
void visit_fields(const AuthoredGrips& c, V&& visit) {
    visit("grips", c.grips);
    visit("count", c.count);
}
template <typename V>
void visit_fields(const AuthoredHold& c, V&& visit) {
    visit("body", c.body);
    visit("grip", c.grip);
    visit("hand", c.hand);
    visit("leave_angle_rad", c.leave_angle_rad);
}
template <typename V>
void visit_fields(const BodyHold& c, V&& visit) {
    visit("part", c.part);
    visit("start_ps", c.start_ps);
    visit("pose_ps", c.pose_ps);
}
template <typename V>
void visit_fields(const HandPull& c, V&& visit) {
    visit("body", c.body);
    visit("closed_s", c.closed_s);
}
template <typename V>
void visit_fields(const HandRigChoice& c, V&& visit) {
    visit("index", c.index);
}
template <typename V>
void visit_fields(const FingerAngles& c, V&& visit) {
    visit("curl_rad", c.curl_rad);
    visit("opposition_rad", c.opposition_rad);
}
template <typename V>
void visit_fields(const HandOwner& c, V&& visit) {
    visit("player", c.player);
    visit("side", c.side);
}
template <typename V>
void visit_fields(const HandTracking& c, V&& visit) {
    visit("pose_ps", c.pose_ps);
    visit("start_ps", c.start_ps);
    visit("sample_ps", c.sample_ps);
    visit("sample_t_s", c.sample_t_s);
    visit("state", c.state);
    visit("resumed", c.resumed);
    visit("interrupted", c.interrupted);
    visit("reading_ps", c.reading_ps);
    visit("reading_t_s", c.reading_t_s);
    visit("inferred_t_s", c.inferred_t_s);
    visit("edge", c.edge);
    visit("edge_t_s", c.edge_t_s);
    visit("edge_ps", c.edge_ps);
    visit("pressed", c.pressed);
    visit("raw_pressed", c.raw_pressed);
    visit("squeeze", c.squeeze);
    visit("trigger", c.trigger);
    visit("curls", c.curls);
    visit("release_velocity_ps_mps", c.release_velocity_ps_mps);
    visit("release_spin_ps_radps", c.release_spin_ps_radps);
}
template <typename V>
void visit_fields(const HandHistory::Entry& c, V&& visit) {
    visit("t_s", c.t_s);
    visit("hand_ps", c.hand_ps);
}
template <typename V>
void visit_fields(const HandHistory& c, V&& visit) {
    visit("entries", c.entries);
    visit("next", c.next);
    visit("count", c.count);
}
template <typename V>
void visit_fields(const Grab& c, V&& visit) {
    visit("kind", c.kind);
    visit("phase", c.phase);
    visit("body", c.body);
    visit("jointed", c.jointed);
    visit("two_handed", c.two_handed);
    visit("hit_bs", c.hit_bs);
    visit("hit_normal_bs", c.hit_normal_bs);
    visit("anchor_bs", c.anchor_bs);
    visit("target_ps", c.target_ps);
    visit("target_velocity_ps_mps", c.target_velocity_ps_mps);
    visit("target_spin_ps_radps", c.target_spin_ps_radps);
    visit("since_s", c.since_s);
    visit("error_m", c.error_m);
    visit("slip_hs", c.slip_hs);
}
template <typename V>
void visit_fields(const HandSight& c, V&& visit) {
    visit("outside_bs", c.outside_bs);
    visit("frame", c.frame);
    visit("is_known", c.is_known);
    visit("is_clear", c.is_clear);
}
template <typename V>
void visit_fields(const GripSurface& c, V&& visit) {
    visit("body", c.body);
    visit("triangle", c.triangle);
    visit("point_bs", c.point_bs);
    visit("normal_bs", c.normal_bs);
    visit("wrist_bs", c.wrist_bs);
    visit("surroundings_signature", c.surroundings_signature);
    visit("fitted_wrist_bs", c.fitted_wrist_bs);
}
template <typename V>
void visit_fields(const PalmOffset& c, V&& visit) {
    visit("held_m", c.held_m);
    visit("held_turn_rad", c.held_turn_rad);
    visit("target_m", c.target_m);
    visit("target_turn_rad", c.target_turn_rad);
    visit("shown_m", c.shown_m);
    visit("shown_turn_rad", c.shown_turn_rad);
}
template <typename V>
void visit_fields(const PalmPose& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
}
template <typename V>
void visit_fields(const FingerPose& c, V&& visit) {
    visit("shown", c.shown);
    visit("target", c.target);
    visit("closed", c.closed);
    visit("touches", c.touches);
    visit("is_closed_clear", c.is_closed_clear);
    visit("is_authored", c.is_authored);
    visit("authored_pose_rejected", c.authored_pose_rejected);
    visit("closed_body", c.closed_body);
    visit("closed_wrist_bs", c.closed_wrist_bs);
    visit("closed_point_bs", c.closed_point_bs);
    visit("closed_normal_bs", c.closed_normal_bs);
    visit("is_closed_in_grip", c.is_closed_in_grip);
    visit("is_newly_closed", c.is_newly_closed);
    visit("fitted_body", c.fitted_body);
    visit("is_clear", c.is_clear);
    visit("fitted_wrist_bs", c.fitted_wrist_bs);
    visit("fitted_signature", c.fitted_signature);
    visit("is_converged", c.is_converged);
    visit("thumbs_tried", c.thumbs_tried);
}
template <typename V>
void visit_fields(const ControllerToHand& c, V&& visit) {
    visit("hand_in_controller", c.hand_in_controller);
}

}  // namespace handhold
