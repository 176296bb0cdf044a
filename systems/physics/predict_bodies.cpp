#include "systems/physics/predict_bodies.hpp"

#include "engine/solver/model/free_rotation.hpp"

namespace handhold {
void predict_bodies(const PredictBodiesIo& io) {
    FreeRotations rotations(io.dt_s);
    const bool has_gravity = io.gravity_mps2 != Vec3::Zero();
    for (std::size_t index = 0; index < io.body.size(); ++index) {
        const RigidBody& body = io.body.elements()[index];
        if (body.kind != BodyKind::free) {
            continue;
        }
        const Entity entity = io.body.owners()[index];
        Pose& pose_ws = io.body_pose.at(entity).pose_ws;
        BodyVelocity& velocity = io.body_velocity.at(entity);
        io.body_start.at(entity).pose_ws = pose_ws;
        if (has_gravity) {
            const GravityScale* const scale = io.gravity_scale.find(entity);
            velocity.linear_mps +=
                (scale != nullptr ? scale->scale : 1.0) * io.dt_s * io.gravity_mps2;
        }
        pose_ws.position += velocity.linear_mps * io.dt_s;
        rotations.add(body.inertia_kgm2, pose_ws.rotation, velocity.angular_radps);
    }
    rotations.finish();
    for (std::size_t index = 0; index < io.origin.size(); ++index) {
        const Entity player = io.origin.owners()[index];
        Pose& pose_ws = io.origin.elements()[index].pose_ws;
        io.player_start.at(player).pose_ws = pose_ws;
        pose_ws.position += io.player_velocity.at(player).linear_mps * io.dt_s;
    }
}

}  // namespace handhold
