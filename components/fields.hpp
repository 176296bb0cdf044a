#pragma once

#include <cstdint>

#include "components/world.hpp"

// visit_fields(component, visit) calls visit("name", field) for every field of a component. State
// hashes, snapshots and the inspector use it. Components are never copied or hashed as bytes:
// Eigen's types have padding and are not trivially copyable. A test checks that every field is
// visited.
//
// Field names are part of the snapshot schema: raise k_format_version in systems/snapshot.cpp if
// they change.
namespace handhold {

// Number of values of an enum that components use; valid values are [0, k_value_count). Loading a
// snapshot checks this range. Code that visits an enum without a specialisation does not compile.
template <typename Enum>
inline constexpr std::uint32_t k_value_count = 0;
template <>
inline constexpr std::uint32_t k_value_count<BodyKind> = 3;
template <>
inline constexpr std::uint32_t k_value_count<TrackingState> = 3;
template <>
inline constexpr std::uint32_t k_value_count<HandSide> = 2;
template <>
inline constexpr std::uint32_t k_value_count<GrabEdge> = 3;
template <>
inline constexpr std::uint32_t k_value_count<GripKind> = 5;
template <>
inline constexpr std::uint32_t k_value_count<GrabPhase> = 4;
template <>
inline constexpr std::uint32_t k_value_count<JointKind> = 5;
template <>
inline constexpr std::uint32_t k_value_count<LegBone> = 2;

template <typename V>
void visit_fields(const PersistentId& c, V&& visit) {
    visit("value", c.value);
}
template <typename V>
void visit_fields(const RigidBody& c, V&& visit) {
    visit("kind", c.kind);
    visit("mass_kg", c.mass_kg);
    visit("inertia_kgm2", c.inertia_kgm2);
    visit("restitution", c.restitution);
    visit("friction", c.friction);
}
template <typename V>
void visit_fields(const BodyPose& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
}
template <typename V>
void visit_fields(const BodyStart& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
}
template <typename V>
void visit_fields(const BodyVelocity& c, V&& visit) {
    visit("linear_mps", c.linear_mps);
    visit("angular_radps", c.angular_radps);
}
template <typename V>
void visit_fields(const Collider& c, V&& visit) {
    visit("shape", c.shape);
}
template <typename V>
void visit_fields(const LastValidPose& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
    visit("known", c.known);
}
template <typename V>
void visit_fields(const AuthoredHand& c, V&& visit) {
    visit("is_there", c.is_there);
    visit("wrist_bs", c.wrist_bs);
    visit("is_posed", c.is_posed);
    visit("fingers", c.fingers);
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
void visit_fields(const HandPull& c, V&& visit) {
    visit("body", c.body);
    visit("closed_s", c.closed_s);
}
template <typename V>
void visit_fields(const Mover& c, V&& visit) {
    visit("start_ws", c.start_ws);
    visit("velocity_ws_mps", c.velocity_ws_mps);
    visit("angular_velocity_ws_radps", c.angular_velocity_ws_radps);
    visit("turns_with_body", c.turns_with_body);
}
template <typename V>
void visit_fields(const JointLatch& c, V&& visit) {
    visit("at", c.at);
    visit("catch_range", c.catch_range);
    visit("strength", c.strength);
    visit("handle", c.handle);
    visit("handle_at", c.handle_at);
}
template <typename V>
void visit_fields(const MoveTarget& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
}
template <typename V>
void visit_fields(const GravityScale& c, V&& visit) {
    visit("scale", c.scale);
}
template <typename V>
void visit_fields(const CollisionFilter& c, V&& visit) {
    visit("layers", c.layers);
    visit("mask", c.mask);
}
template <typename V>
void visit_fields(const GrabRule& c, V&& visit) {
    visit("left", c.left);
    visit("right", c.right);
    visit("two_hands", c.two_hands);
    visit("priority", c.priority);
}
template <typename V>
void visit_fields(const GrabLayers& c, V&& visit) {
    visit("layers", c.layers);
}
template <typename V>
void visit_fields(const GrabOrder& c, V&& visit) {
    visit("body", c.body);
}
template <typename V>
void visit_fields(const HandRigChoice& c, V&& visit) {
    visit("index", c.index);
}
template <typename V>
void visit_fields(const Joint& c, V&& visit) {
    visit("kind", c.kind);
    visit("a", c.a);
    visit("b", c.b);
    visit("frame_a_bs", c.frame_a_bs);
    visit("frame_b_bs", c.frame_b_bs);
    visit("collides", c.collides);
    visit("limited", c.limited);
    visit("lower", c.lower);
    visit("upper", c.upper);
    visit("friction", c.friction);
    visit("detent_spacing", c.detent_spacing);
    visit("detent_strength", c.detent_strength);
    visit("latch", c.latch);
}
template <typename V>
void visit_fields(const JointState& c, V&& visit) {
    visit("coordinate", c.coordinate);
    visit("speed", c.speed);
    visit("latched", c.latched);
}
template <typename V>
void visit_fields(const PathKey& c, V&& visit) {
    visit("pose", c.pose);
    visit("velocity_mps", c.velocity_mps);
    visit("quaternion_rate", c.quaternion_rate);
}
template <typename V>
void visit_fields(const PosePath& c, V&& visit) {
    visit("keys", c.keys);
    visit("count", c.count);
    visit("period_s", c.period_s);
}
template <typename V>
void visit_fields(const PathMover& c, V&& visit) {
    visit("path", c.path);
}
template <typename V>
void visit_fields(const CrawlerLeg& c, V&& visit) {
    visit("hip_bs", c.hip_bs);
    visit("foot_bs", c.foot_bs);
    visit("knee_bs", c.knee_bs);
    visit("upper_m", c.upper_m);
    visit("lower_m", c.lower_m);
    visit("phase", c.phase);
}
template <typename V>
void visit_fields(const CrawlerGait& c, V&& visit) {
    visit("step_s", c.step_s);
    visit("standing", c.standing);
    visit("lift_m", c.lift_m);
}
template <typename V>
void visit_fields(const LegMover& c, V&& visit) {
    visit("torso", c.torso);
    visit("leg", c.leg);
    visit("gait", c.gait);
    visit("bone", c.bone);
}
template <typename V>
void visit_fields(const PlayerBody& c, V&& visit) {
    visit("mass_kg", c.mass_kg);
}
template <typename V>
void visit_fields(const PlayerOrigin& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
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
}
template <typename V>
void visit_fields(const EarlySample& c, V&& visit) {
    visit("t_s", c.t_s);
    visit("head_ps", c.head_ps);
    visit("controllers_ps", c.controllers_ps);
    visit("head_tracked", c.head_tracked);
    visit("tracked", c.tracked);
    visit("grab", c.grab);
}
template <typename V>
void visit_fields(const HeadIgnores& c, V&& visit) {
    visit("bodies", c.bodies);
    visit("next", c.next);
}
template <typename V>
void visit_fields(const FingerAngles& c, V&& visit) {
    visit("curl_rad", c.curl_rad);
    visit("opposition_rad", c.opposition_rad);
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
template <typename V>
void visit_fields(const ArmMemory::Arm& c, V&& visit) {
    visit("axis_ts", c.axis_ts);
    visit("bend_ts", c.bend_ts);
    visit("hand_ts", c.hand_ts);
    visit("elbow_ts", c.elbow_ts);
    visit("hand_ps", c.hand_ps);
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
    visit("shoulder_ps", c.shoulder_ps);
    visit("bend_ps", c.bend_ps);
    visit("stretch", c.stretch);
}
template <typename V>
void visit_fields(const ArmEstimate& c, V&& visit) {
    visit("chest_ps", c.chest_ps);
    visit("facing_ps", c.facing_ps);
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
void visit_fields(const LegContact& c, V&& visit) {
    visit("touches", c.touches);
    visit("normal_ps", c.normal_ps);
    visit("surface_m", c.surface_m);
    visit("ankle_m", c.ankle_m);
}
template <typename V>
void visit_fields(const SpineMemory& c, V&& visit) {
    visit("known", c.known);
    visit("since_tick_s", c.since_tick_s);
    visit("moved_m", c.moved_m);
    visit("chest_ps", c.chest_ps);
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
}
template <typename V>
void visit_fields(const BodyClipState& c, V&& visit) {
    visit("gripping", c.gripping);
    visit("was_gripping", c.was_gripping);
    visit("idle_s", c.idle_s);
    visit("push_off_s", c.push_off_s);
    visit("push_off_weight", c.push_off_weight);
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
    visit("edge", c.edge);
    visit("edge_t_s", c.edge_t_s);
    visit("edge_ps", c.edge_ps);
    visit("pressed", c.pressed);
    visit("raw_pressed", c.raw_pressed);
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
    visit("has_fitted_wrist", c.has_fitted_wrist);
    visit("candidate_recheck_in_m", c.candidate_recheck_in_m);
    visit("candidates", c.candidates);
    visit("evaluated_count", c.evaluated_count);
    visit("candidate_count", c.candidate_count);
    visit("cost_m", c.cost_m);
    visit("allows_backfaces", c.allows_backfaces);
    visit("pending_finger_samples", c.pending_finger_samples);
    visit("clearance_recheck_in_m", c.clearance_recheck_in_m);
    visit("finger_samples", c.finger_samples);
    visit("full_search_in_m", c.full_search_in_m);
    visit("is_converged", c.is_converged);
    visit("stationary_refine_frames", c.stationary_refine_frames);
    visit("evaluated_this_frame", c.evaluated_this_frame);
}
template <typename V>
void visit_fields(const PalmOffset& c, V&& visit) {
    visit("held_m", c.held_m);
    visit("held_turn_rad", c.held_turn_rad);
    visit("target_m", c.target_m);
    visit("target_turn_rad", c.target_turn_rad);
    visit("shown_m", c.shown_m);
    visit("shown_turn_rad", c.shown_turn_rad);
    visit("solved_wrist_bs", c.solved_wrist_bs);
    visit("solved_signature", c.solved_signature);
    visit("solved_triangle", c.solved_triangle);
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
}
template <typename V>
void visit_fields(const ControllerToHand& c, V&& visit) {
    visit("hand_in_controller", c.hand_in_controller);
}

}  // namespace handhold
