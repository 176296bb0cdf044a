#include "systems/grab/keep_holds.hpp"

namespace handhold {

void keep_holds(const KeepHoldsIo& io) {
    for (std::size_t index = 0; index < io.reference.size(); ++index) {
        io.reference.elements()[index] = {io.scene_velocity_mps, k_no_entity, Vec3::Zero()};
    }
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        Grab& grab = io.grab.elements()[index];
        if (grab.kind == GripKind::none) {
            continue;
        }
        if (!io.body.contains(grab.body)) {
            grab = {};
            continue;
        }
        const Entity hand = io.grab.owners()[index];
        const Entity player = io.owner.at(hand).player;
        const Pose& body_ws = io.body_pose.at(grab.body).pose_ws;
        const Vec3 anchor_ws = transform_point(body_ws, grab.anchor_bs.position);
        const Vec3 hand_ws =
            transform_point(io.origin.at(player).pose_ws, io.hand.at(hand).pose_ps.position);
        grab.error_m = (hand_ws - anchor_ws).norm();
        if (grab.kind == GripKind::surface) {
            const BodyVelocity& velocity = io.body_velocity.at(grab.body);
            const Vec3 arm_ws = anchor_ws - body_ws.position;
            io.reference.at(player) = {velocity.linear_mps + velocity.angular_radps.cross(arm_ws),
                                       grab.body, grab.anchor_bs.position};
        }
    }
}

}  // namespace handhold
