// Runs a scene of boxes in Box3D, one thread, four sub-steps, no sleeping. usage: peer_box3d SCENE
#include <box3d/box3d.h>

#include "peer_scene.hpp"

namespace {

using namespace handhold::peers;

b3Vec3 to_vec3(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
b3Quat to_quat(const std::array<double, 4>& q) {
    return {{static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])},
            static_cast<float>(q[3])};
}
b3WorldTransform to_transform(const Placed& pose) {
    return {b3ToPos(to_vec3(pose.position)), to_quat(pose.rotation)};
}

b3BodyId add_body(b3WorldId world, const Body& body) {
    b3BodyDef def = b3DefaultBodyDef();
    def.type = body.motion == Motion::free     ? b3_dynamicBody
               : body.motion == Motion::driven ? b3_kinematicBody
                                               : b3_staticBody;
    def.position = b3ToPos(to_vec3(body.pose.position));
    def.rotation = to_quat(body.pose.rotation);
    def.linearVelocity = to_vec3(body.velocity_mps);
    def.angularVelocity = to_vec3(body.spin_radps);
    def.enableSleep = false;
    const b3BodyId id = b3CreateBody(world, &def);
    b3ShapeDef shape = b3DefaultShapeDef();
    shape.baseMaterial.friction = static_cast<float>(body.friction);
    shape.baseMaterial.restitution = static_cast<float>(body.restitution);
    const double volume_m3 = 8.0 * body.half_m[0] * body.half_m[1] * body.half_m[2];
    shape.density = static_cast<float>(body.mass_kg / volume_m3);  // solid boxes, as in the lab
    const b3Vec3 half = to_vec3(body.half_m);
    const b3BoxHull hull = b3MakeBoxHull(half.x, half.y, half.z);
    b3CreateHullShape(id, &shape, &hull.base);
    return id;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: peer_box3d SCENE\n");
        return 1;
    }
    const Scene scene = read_scene(arguments[1]);
    b3WorldDef def = b3DefaultWorldDef();
    def.gravity = {0.0F, 0.0F, 0.0F};
    def.enableSleep = false;
    def.workerCount = 1;
    const b3WorldId world = b3CreateWorld(&def);
    b3BodyId driven{};
    for (const Body& body : scene.bodies) {
        const b3BodyId id = add_body(world, body);
        driven = body.motion == Motion::driven ? id : driven;
    }
    const auto dt_s = static_cast<float>(1.0 / scene.hz);
    time_frames(scene, "Box3D", [&](int frame) {
        if (static_cast<std::size_t>(frame) < scene.driven.size()) {
            b3Body_SetTargetTransform(
                driven, to_transform(scene.driven[static_cast<std::size_t>(frame)]), dt_s, true);
        }
        b3World_Step(world, dt_s, 4);
    });
    b3DestroyWorld(world);
    return 0;
}
