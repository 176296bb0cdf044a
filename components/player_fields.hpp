#pragma once

#include "components/world.hpp"

// visit_fields for the components of players, arms, spines and rendering (see fields.hpp).
namespace handhold {

template <typename V>
void visit_fields(const PlayerBody& c, V&& visit) {
    visit("mass_kg", c.mass_kg);
}
template <typename V>
void visit_fields(const PlayerOrigin& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
    visit("scale", c.scale);
}
template <typename V>
void visit_fields(const PlayerStart& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
}
template <typename V>
void visit_fields(const PlayerVelocity& c, V&& visit) {
    visit("linear_mps", c.linear_mps);
}
template <typename V>
void visit_fields(const PlayerCommands& c, V&& visit) {
    visit("smooth_turn", c.smooth_turn);
    visit("snap_turns", c.snap_turns);
    visit("brake", c.brake);
    visit("thrust_ps", c.thrust_ps);
    visit("calibrate", c.calibrate);
}
template <typename V>
void visit_fields(const ReferenceVelocity& c, V&& visit) {
    visit("linear_mps", c.linear_mps);
    visit("body", c.body);
    visit("point_bs", c.point_bs);
}
template <typename V>
void visit_fields(const HeadTracking& c, V&& visit) {
    visit("pose_ps", c.pose_ps);
    visit("start_ps", c.start_ps);
    visit("sample_ps", c.sample_ps);
    visit("sample_t_s", c.sample_t_s);
    visit("before_ps", c.before_ps);
    visit("before_t_s", c.before_t_s);
    visit("state", c.state);
    visit("shift_m", c.shift_m);
    visit("shift_turn", c.shift_turn);
    visit("is_inferred", c.is_inferred);
}
template <typename V>
void visit_fields(const RecenterGuess& c, V&& visit) {
    visit("guesses", c.guesses);
}
template <typename V>
void visit_fields(const EarlySample& c, V&& visit) {
    visit("t_s", c.t_s);
    visit("head_ps", c.head_ps);
    visit("controllers_ps", c.controllers_ps);
    visit("head_tracked", c.head_tracked);
    visit("tracked", c.tracked);
    visit("grab", c.grab);
    visit("squeeze", c.squeeze);
    visit("trigger", c.trigger);
    visit("head_inferred", c.head_inferred);
    visit("inferred", c.inferred);
    visit("curls", c.curls);
}
template <typename V>
void visit_fields(const EarlySamples& c, V&& visit) {
    visit("count", c.count);
    visit("samples", c.kept());
}
template <typename V>
void visit_fields(const HeadIgnores& c, V&& visit) {
    visit("bodies", c.bodies);
    visit("next", c.next);
}
template <typename V>
void visit_fields(const BodyMeasures& c, V&& visit) {
    visit("eye_height_m", c.eye_height_m);
    visit("shoulder_width_m", c.shoulder_width_m);
    visit("upper_arm_m", c.upper_arm_m);
    visit("forearm_m", c.forearm_m);
}
template <typename V>
void visit_fields(const Calibration& c, V&& visit) {
    visit("done", c.done);
    visit("held_s", c.held_s);
    visit("eyes_s_m", c.eyes_s_m);
    visit("span_s_m", c.span_s_m);
    visit("left_ps", c.left_ps);
    visit("right_ps", c.right_ps);
}
template <std::size_t Bins, typename V>
void visit_fields(const LengthHistogram<Bins>& c, V&& visit) {
    visit("time_s", c.time_s);
}
template <typename V>
void visit_fields(const SizeEstimate& c, V&& visit) {
    visit("is_measured", c.is_measured);
    visit("eyes", c.eyes);
    visit("reach", c.reach);
}
template <typename V>
void visit_fields(const HandRest& c, V&& visit) {
    visit("is_away", c.is_away);
    visit("share", c.share);
    visit("from_vs", c.from_vs);
}
template <typename V>
void visit_fields(const ArmMemory::Arm& c, V&& visit) {
    visit("axis_ts", c.axis_ts);
    visit("bend_ts", c.bend_ts);
    visit("hand_ts", c.hand_ts);
    visit("elbow_ts", c.elbow_ts);
    visit("hand_ps", c.hand_ps);
    visit("rest", c.rest);
    visit("cleared_rad", c.cleared_rad);
    visit("cleared_known", c.cleared_known);
}
template <typename V>
void visit_fields(const ChestOffset& c, V&& visit) {
    visit("middle_m", c.middle_m);
    visit("roll", c.roll);
}
template <typename V>
void visit_fields(const ArmMemory& c, V&& visit) {
    visit("known", c.known);
    visit("looks_ps", c.looks_ps);
    visit("facing_ps", c.facing_ps);
    visit("chest", c.chest);
    visit("head_ps", c.head_ps);
    visit("arms", c.arms);
}
template <typename V>
void visit_fields(const ArmEstimate::Arm& c, V&& visit) {
    visit("hand_ps", c.hand_ps);
    visit("goal", c.goal);
    visit("shoulder_ps", c.shoulder_ps);
    visit("bend_ps", c.bend_ps);
    visit("stretch", c.stretch);
}
template <typename V>
void visit_fields(const ArmEstimate& c, V&& visit) {
    visit("chest_ps", c.chest_ps);
    visit("facing_ps", c.facing_ps);
    visit("lying", c.lying);
    visit("from_neck_m", c.from_neck_m);
    visit("arms", c.arms);
}
template <typename V>
void visit_fields(const ArmPose::Arm& c, V&& visit) {
    visit("clavicle_ws", c.clavicle_ws);
    visit("upper_ws", c.upper_ws);
    visit("forearm_ws", c.forearm_ws);
    visit("hand_ws", c.hand_ws);
}
template <typename V>
void visit_fields(const ArmPose& c, V&& visit) {
    visit("chest_ws", c.chest_ws);
    visit("arms", c.arms);
}
template <typename V>
void visit_fields(const BodyContact& c, V&& visit) {
    visit("touches", c.touches);
    visit("normal_ps", c.normal_ps);
    visit("surface_m", c.surface_m);
}
template <typename V>
void visit_fields(const BodySearch& c, V&& visit) {
    visit("known", c.known);
    visit("from_ws", c.from_ws);
    visit("to_ws", c.to_ws);
    visit("near", c.near);
    visit("hits", c.hits);
    visit("point_ws", c.point_ws);
    visit("normal_ws", c.normal_ws);
}
template <typename V>
void visit_fields(const BodyPull& c, V&& visit) {
    visit("now", c.now);
    visit("before", c.before);
    visit("rate_per_s", c.rate_per_s);
    visit("hands", c.hands);
    visit("hands_before", c.hands_before);
}
template <typename V>
void visit_fields(const ShownJoint& c, V&& visit) {
    visit("known", c.known);
    visit("wanted_m", c.wanted_m);
    visit("shown_m", c.shown_m);
    visit("velocity_mps", c.velocity_mps);
}
template <typename V>
void visit_fields(const SpineMemory& c, V&& visit) {
    visit("known", c.known);
    visit("since_tick_s", c.since_tick_s);
    visit("moved_m", c.moved_m);
    visit("chest_ps", c.chest_ps);
    visit("neck_ps", c.neck_ps);
    visit("head_ps", c.head_ps);
    visit("rate_mps", c.rate_mps);
    visit("rate_span_s", c.rate_span_s);
    visit("tick_chest_ps", c.tick_chest_ps);
    visit("reference_ws_mps", c.reference_ws_mps);
    visit("offset_m", c.offset_m);
    visit("before_m", c.before_m);
    visit("velocity_mps", c.velocity_mps);
    visit("twist_rad", c.twist_rad);
    visit("angle_rad", c.angle_rad);
    visit("contacts", c.contacts);
    visit("searches", c.searches);
    visit("pull", c.pull);
    visit("pelvis", c.pelvis);
    visit("feet", c.feet);
    visit("hips_m", c.hips_m);
}
template <typename V>
void visit_fields(const BodyClipState& c, V&& visit) {
    visit("gripping", c.gripping);
    visit("was_gripping", c.was_gripping);
    visit("idle_s", c.idle_s);
    visit("push_off_s", c.push_off_s);
    visit("push_off_weight", c.push_off_weight);
    visit("outside", c.outside);
}
template <typename V>
void visit_fields(const SpinePose::Leg& c, V&& visit) {
    visit("thigh_ws", c.thigh_ws);
    visit("shin_ws", c.shin_ws);
    visit("foot_ws", c.foot_ws);
}
template <typename V>
void visit_fields(const SpinePose& c, V&& visit) {
    visit("chest_ws", c.chest_ws);
    visit("spine_ws", c.spine_ws);
    visit("pelvis_ws", c.pelvis_ws);
    visit("legs", c.legs);
}
template <typename V>
void visit_fields(const RenderPose::Hand& c, V&& visit) {
    visit("tracked_ws", c.tracked_ws);
    visit("shown_ws", c.shown_ws);
    visit("ray_from_ws", c.ray_from_ws);
    visit("ray_to_ws", c.ray_to_ws);
    visit("grip", c.grip);
    visit("fingers", c.fingers);
}
template <typename V>
void visit_fields(const RenderPose& c, V&& visit) {
    visit("head_ws", c.head_ws);
    visit("head_center_ws", c.head_center_ws);
    visit("hands", c.hands);
    visit("push_back_m", c.push_back_m);
    visit("arms", c.arms);
    visit("spine", c.spine);
}

}  // namespace handhold
