#include "systems/physics/animate_movers.hpp"

namespace handhold {

Pose mover_pose(const Mover& mover, double t_s) {
    const Vec3& spin = mover.angular_velocity_ws_radps;
    const Vec3& velocity = mover.velocity_ws_mps;
    const double rate = spin.norm();
    Pose pose = mover.start_ws;
    if (rate < 1e-12) {
        pose.position += velocity * t_s;
        return pose;
    }
    const Vec3 axis = spin / rate;
    pose.rotation = (rotation_about(axis, rate * t_s) * mover.start_ws.rotation).normalized();
    if (!mover.turns_with_body) {
        pose.position += velocity * t_s;
        return pose;
    }
    // Integral of the rotating velocity: the component along the axis is linear, the rest moves on
    // a circle. Uses half angles, because 1 - cosine loses precision for slow spins.
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(0.5 * rate * t_s, sine, cosine);
    const Vec3 along = axis * axis.dot(velocity);
    const Vec3 across = velocity - along;
    pose.position +=
        along * t_s + (2.0 * sine / rate) * (across * cosine + axis.cross(across) * sine);
    return pose;
}

BodyVelocity mover_velocity(const Mover& mover, double t_s) {
    const Vec3& spin = mover.angular_velocity_ws_radps;
    if (!mover.turns_with_body) {
        return {mover.velocity_ws_mps, spin};
    }
    return {rotation_from_vector(spin * t_s) * mover.velocity_ws_mps, spin};
}

BodyVelocity leg_velocity(const PosePath& torso, const LegMover& mover, double t_s) {
    const auto pose_at = [&](double at_s) {
        return crawler_bone_pose(torso, mover.gait, mover.leg, mover.bone, at_s);
    };
    const Pose before = pose_at(t_s - k_leg_step_s);
    const Pose after = pose_at(t_s + k_leg_step_s);
    return {
        (after.position - before.position) / (2.0 * k_leg_step_s),
        rotation_to_vector(after.rotation * before.rotation.conjugate()) / (2.0 * k_leg_step_s)};
}

void animate_movers(const AnimateMoversIo& io) {
    const auto move = [&io](Entity body, const Pose& pose_ws, const BodyVelocity& velocity) {
        io.body_start.at(body).pose_ws = io.body_pose.at(body).pose_ws;
        io.body_pose.at(body).pose_ws = pose_ws;
        io.velocity.at(body) = velocity;
    };
    for (std::size_t index = 0; index < io.mover.size(); ++index) {
        const Mover& mover = io.mover.elements()[index];
        move(io.mover.owners()[index], mover_pose(mover, io.end_s),
             mover_velocity(mover, io.end_s));
    }
    for (std::size_t index = 0; index < io.path_mover.size(); ++index) {
        const PosePathState state = evaluate(io.path_mover.elements()[index].path, io.end_s);
        move(io.path_mover.owners()[index], state.pose,
             {state.velocity_mps, state.angular_velocity_radps});
    }
    for (std::size_t index = 0; index < io.leg_mover.size(); ++index) {
        const Entity body = io.leg_mover.owners()[index];
        const LegMover& mover = io.leg_mover.elements()[index];
        const PathMover* const torso = io.path_mover.find(mover.torso);
        if (torso == nullptr) {
            move(body, io.body_pose.at(body).pose_ws, {});
            continue;
        }
        move(body, crawler_bone_pose(torso->path, mover.gait, mover.leg, mover.bone, io.end_s),
             leg_velocity(torso->path, mover, io.end_s));
    }
    for (std::size_t index = 0; index < io.target.size(); ++index) {
        const Entity body = io.target.owners()[index];
        const Pose& start_ws = io.body_pose.at(body).pose_ws;
        const Pose& end_ws = io.target.elements()[index].pose_ws;
        const Quat turn = end_ws.rotation * start_ws.rotation.conjugate();
        move(body, end_ws,
             {(end_ws.position - start_ws.position) / io.dt_s,
              rotation_to_vector(turn.normalized()) / io.dt_s});
    }
}

}  // namespace handhold
