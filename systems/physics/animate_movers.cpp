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
    // The integral of the turning velocity: its part along the axis goes straight, the rest runs
    // round a circle. From half the angle, since 1 - cosine loses its digits where the spin is
    // slow.
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

void animate_movers(const AnimateMoversIo& io) {
    for (std::size_t row = 0; row < io.mover.size(); ++row) {
        const Entity body = io.mover.owners()[row];
        const Mover& mover = io.mover.rows()[row];
        io.body_start.at(body).pose_ws = io.body_pose.at(body).pose_ws;
        io.body_pose.at(body).pose_ws = mover_pose(mover, io.end_s);
        io.velocity.at(body) = mover_velocity(mover, io.end_s);
    }
}

}  // namespace handhold
