#pragma once

#include "components/world.hpp"

// visit_fields for the components of bodies, joints and movers (see fields.hpp).
namespace handhold {

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
void visit_fields(const MoveTarget::Move& c, V&& visit) {
    visit("span_s", c.span_s);
    visit("moved_m", c.moved_m);
    visit("turned_rad", c.turned_rad);
}
template <typename V>
void visit_fields(const MoveTarget& c, V&& visit) {
    visit("pose_ws", c.pose_ws);
    visit("moved_s", c.moved_s);
    visit("count", c.count);
    visit("moves", c.kept());
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
void visit_fields(const JointMotor& c, V&& visit) {
    visit("kind", c.kind);
    visit("speed", c.speed);
    visit("position", c.position);
    visit("time_s", c.time_s);
    visit("strength", c.strength);
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
    visit("motor", c.motor);
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

}  // namespace handhold
