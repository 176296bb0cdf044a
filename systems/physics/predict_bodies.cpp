#include "systems/physics/predict_bodies.hpp"

namespace handhold {
namespace {

// Spin of a body with this angular momentum, world axes.
Vec3 spin_of(const Quat& rotation, const Vec3& inertia_kgm2, const Vec3& momentum_ws) {
    const Vec3 momentum_bs = rotation.conjugate() * momentum_ws;
    return rotation * Vec3(momentum_bs.cwiseQuotient(inertia_kgm2));
}

void predict_rotation(const RigidBody& body, double dt_s, Quat& rotation, Vec3& spin_radps) {
    if (spin_radps.squaredNorm() == 0.0) {
        return;
    }
    const Vec3 spin_bs = rotation.conjugate() * spin_radps;
    const Vec3 momentum_ws = rotation * Vec3(body.inertia_kgm2.cwiseProduct(spin_bs));
    const Quat halfway = (rotation_from_vector(0.5 * dt_s * spin_radps) * rotation).normalized();
    const Vec3 spin_halfway = spin_of(halfway, body.inertia_kgm2, momentum_ws);
    rotation = (rotation_from_vector(dt_s * spin_halfway) * rotation).normalized();
    spin_radps = spin_of(rotation, body.inertia_kgm2, momentum_ws);
}

}  // namespace

void predict_bodies(const PredictBodiesIo& io) {
    for (std::size_t row = 0; row < io.body.size(); ++row) {
        const RigidBody& body = io.body.rows()[row];
        if (body.kind != BodyKind::free) {
            continue;
        }
        const Entity entity = io.body.owners()[row];
        Pose& pose_ws = io.body_pose.at(entity).pose_ws;
        BodyVelocity& velocity = io.body_velocity.at(entity);
        io.body_start.at(entity).pose_ws = pose_ws;
        pose_ws.position += velocity.linear_mps * io.dt_s;
        predict_rotation(body, io.dt_s, pose_ws.rotation, velocity.angular_radps);
    }
    for (std::size_t row = 0; row < io.origin.size(); ++row) {
        const Entity player = io.origin.owners()[row];
        Pose& pose_ws = io.origin.rows()[row].pose_ws;
        io.player_start.at(player).pose_ws = pose_ws;
        pose_ws.position += io.player_velocity.at(player).linear_mps * io.dt_s;
    }
}

}  // namespace handhold
