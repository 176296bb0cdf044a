// Runs a scene of boxes in Jolt at its default settings, one thread, no sleeping. usage: peer_jolt
// SCENE
// clang-format off: Jolt.h comes before all other headers of Jolt
#include <Jolt/Jolt.h>
// clang-format on

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/PhysicsSettings.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include "peer_scene.hpp"

namespace {

using namespace handhold::peers;

JPH::Vec3 to_vec3(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
JPH::Quat to_quat(const std::array<double, 4>& q) {
    return JPH::Quat(static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
                     static_cast<float>(q[3]))
        .Normalized();
}

// Two layers: what may move, and what never does. The latter does not collide with itself.
constexpr JPH::ObjectLayer k_moving = 0;
constexpr JPH::ObjectLayer k_still = 1;

class Layers final : public JPH::BroadPhaseLayerInterface {
  public:
    JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
    JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
        return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
    }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
    const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer /*layer*/) const override {
        return "layer";
    }
#endif
};

class LayerAgainstTree final : public JPH::ObjectVsBroadPhaseLayerFilter {
  public:
    bool ShouldCollide(JPH::ObjectLayer layer, JPH::BroadPhaseLayer tree) const override {
        return layer == k_moving || tree == JPH::BroadPhaseLayer(k_moving);
    }
};

class LayerPairs final : public JPH::ObjectLayerPairFilter {
  public:
    bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
        return a == k_moving || b == k_moving;
    }
};

JPH::BodyID add_body(JPH::BodyInterface& bodies, const Body& body) {
    const JPH::EMotionType motion = body.motion == Motion::free     ? JPH::EMotionType::Dynamic
                                    : body.motion == Motion::driven ? JPH::EMotionType::Kinematic
                                                                    : JPH::EMotionType::Static;
    JPH::BodyCreationSettings settings(
        new JPH::BoxShape(to_vec3(body.half_m)), JPH::RVec3(to_vec3(body.pose.position)),
        to_quat(body.pose.rotation), motion, body.motion == Motion::fixed ? k_still : k_moving);
    settings.mFriction = static_cast<float>(body.friction);
    settings.mRestitution = static_cast<float>(body.restitution);
    settings.mAllowSleeping = false;
    settings.mLinearDamping = settings.mAngularDamping = 0.0F;
    settings.mLinearVelocity = to_vec3(body.velocity_mps);
    settings.mAngularVelocity = to_vec3(body.spin_radps);
    if (body.motion == Motion::free) {
        settings.mOverrideMassProperties = JPH::EOverrideMassProperties::CalculateInertia;
        settings.mMassPropertiesOverride.mMass = static_cast<float>(body.mass_kg);
    }
    return bodies.CreateAndAddBody(settings, JPH::EActivation::Activate);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: peer_jolt SCENE\n");
        return 1;
    }
    const Scene scene = read_scene(arguments[1]);
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();
    JPH::RegisterTypes();
    JPH::TempAllocatorImpl memory(256 * 1024 * 1024);
    JPH::JobSystemSingleThreaded jobs(JPH::cMaxPhysicsJobs);
    const Layers layers;
    const LayerAgainstTree against_tree;
    const LayerPairs pairs;
    JPH::PhysicsSystem physics;
    const auto most = static_cast<JPH::uint>(scene.bodies.size());
    physics.Init(most + 1, 0, 64 * most + 1024, 64 * most + 1024, layers, against_tree, pairs);
    physics.SetGravity(JPH::Vec3::sZero());
    JPH::BodyID driven;
    for (const Body& body : scene.bodies) {
        const JPH::BodyID id = add_body(physics.GetBodyInterface(), body);
        driven = body.motion == Motion::driven ? id : driven;
    }
    physics.OptimizeBroadPhase();
    const auto dt_s = static_cast<float>(1.0 / scene.hz);
    time_frames(scene, "Jolt", [&](int frame) {
        if (static_cast<std::size_t>(frame) < scene.driven.size()) {
            const Placed& pose = scene.driven[static_cast<std::size_t>(frame)];
            physics.GetBodyInterface().MoveKinematic(driven, JPH::RVec3(to_vec3(pose.position)),
                                                     to_quat(pose.rotation), dt_s);
        }
        physics.Update(dt_s, 1, &memory, &jobs);
    });
    JPH::UnregisterTypes();
    delete JPH::Factory::sInstance;
    JPH::Factory::sInstance = nullptr;
    return 0;
}
