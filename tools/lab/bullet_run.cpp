// The only file of the tools that uses Bullet directly.
#include "tools/lab/bullet_run.hpp"

#include <algorithm>

#include <btBulletDynamicsCommon.h>

#include "components/player.hpp"
#include "engine/core/profile.hpp"
#include "tools/lab/hand_paths.hpp"
#include "tools/lab/measure.hpp"

namespace handhold::lab {
namespace {

btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
btTransform to_bullet(const Pose& pose) {
    const Quat& q = pose.rotation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(pose.position));
}
Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Pose from_bullet(const btTransform& transform) {
    const btQuaternion q = transform.getRotation();
    return {from_bullet(transform.getOrigin()), Quat(q.w(), q.x(), q.y(), q.z()).normalized()};
}

// Bullet's hinge axis is z of its frame, ours is x.
btTransform hinge_frame(const Pose& frame) {
    return to_bullet(frame * Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), 0.5 * k_pi)});
}

struct BodyDeleter {
    void operator()(btRigidBody* body) const {
        delete body->getMotionState();
        delete body;
    }
};
using BodyPtr = std::unique_ptr<btRigidBody, BodyDeleter>;

constexpr int k_all = btBroadphaseProxy::AllFilter;

}  // namespace

struct BulletRun::Impl {
    const LabScene& scene;
    Holder holder;
    double dt_s;
    double t_s = 0.0;

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btTriangleMesh>> meshes;
    std::vector<BodyPtr> bodies;  // same order as FrameRecord::poses
    BodyPtr ground;               // fixed body, for joints to the world
    std::vector<std::unique_ptr<btTypedConstraint>> joints;
    // Indexed as LabScene::holds; null: released.
    std::vector<std::unique_ptr<btTypedConstraint>> grabs;

    Impl(const LabScene& of, Holder who, double hz) : scene(of), holder(who), dt_s(1.0 / hz) {
        world.setGravity({0.0, 0.0, 0.0});
        ground = make_body(0.0, Vec3::Zero(), Pose{}, add_shape(new btEmptyShape));
        for (const LabBody& body : scene.bodies) {
            bodies.push_back(make_scene_body(body));
        }
        if (holder == Holder::player) {
            for (const LabPlayer& player : scene.players) {
                bodies.push_back(make_player(player));
            }
        } else {
            for (const LabHold& hold : scene.holds) {
                bodies.push_back(make_kinematic(hand_ws(hold, 0.0)));
            }
        }
        for (const LabJoint& joint : scene.joints) {
            joints.push_back(make_joint(joint));
            world.addConstraint(joints.back().get(), true);
        }
        for (std::size_t i = 0; i < scene.holds.size(); ++i) {
            grabs.push_back(make_grab(i));
            world.addConstraint(grabs.back().get(), true);
        }
    }
    ~Impl() {
        for (const auto& list : {&joints, &grabs}) {
            for (const auto& constraint : *list) {
                if (constraint != nullptr) {
                    world.removeConstraint(constraint.get());
                }
            }
        }
        for (const BodyPtr& body : bodies) {
            world.removeRigidBody(body.get());
        }
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    btCollisionShape* add_shape(btCollisionShape* shape) {
        shapes.emplace_back(shape);
        return shape;
    }

    static BodyPtr make_body(double mass_kg, const Vec3& inertia, const Pose& pose,
                             btCollisionShape* shape) {
        btRigidBody::btRigidBodyConstructionInfo info(
            mass_kg, new btDefaultMotionState(to_bullet(pose)), shape, to_bullet(inertia));
        BodyPtr body(new btRigidBody(info));
        body->setActivationState(DISABLE_DEACTIVATION);
        return body;
    }

    btCollisionShape* make_shape(const LabBody& body) {
        if (body.is_ball) {
            return add_shape(new btSphereShape(body.half_m.x()));
        }
        if (!body.is_mesh) {
            return add_shape(new btBoxShape(to_bullet(body.half_m)));
        }
        const Vec3& h = body.half_m;
        const btVector3 corners[] = {{h.x(), -h.y(), -h.z()},
                                     {h.x(), h.y(), -h.z()},
                                     {h.x(), h.y(), h.z()},
                                     {h.x(), -h.y(), h.z()}};
        meshes.push_back(std::make_unique<btTriangleMesh>());
        meshes.back()->addTriangle(corners[0], corners[1], corners[2]);
        meshes.back()->addTriangle(corners[0], corners[2], corners[3]);
        return add_shape(new btBvhTriangleMeshShape(meshes.back().get(), true));
    }

    BodyPtr make_scene_body(const LabBody& body) {
        const bool is_free = body.kind == BodyKind::free;
        BodyPtr made = make_body(is_free ? body.mass_kg : 0.0,
                                 is_free ? body.inertia_kgm2() : Vec3(Vec3::Zero()), body.pose_ws,
                                 make_shape(body));
        made->setLinearVelocity(to_bullet(body.velocity.linear_mps));
        made->setAngularVelocity(to_bullet(body.velocity.angular_radps));
        // Bullet multiplies the values of the two bodies in a contact, so bodies that are not free
        // have 1.
        made->setFriction(is_free ? body.friction : 1.0);
        made->setRestitution(is_free ? body.restitution : 1.0);
        if (body.kind == BodyKind::kinematic) {
            made->setCollisionFlags(made->getCollisionFlags() |
                                    btCollisionObject::CF_KINEMATIC_OBJECT);
        }
        world.addRigidBody(made.get(), body.collides ? 1 : 0, body.collides ? k_all : 0);
        return made;
    }

    BodyPtr make_player(const LabPlayer& player) {
        auto* const compound = new btCompoundShape;
        add_shape(compound);
        compound->addChildShape(to_bullet(Pose{player.head_ps, Quat::Identity()}),
                                add_shape(new btSphereShape(scene.tuning.head.radius_m)));
        BodyPtr body = make_body(PlayerBody{}.mass_kg, Vec3::Ones(),
                                 {player.origin_ws, Quat::Identity()}, compound);
        body->setAngularFactor(0.0);
        body->setLinearVelocity(to_bullet(player.velocity_mps));
        body->setFriction(scene.tuning.head.friction);
        body->setRestitution(scene.tuning.head.restitution);
        world.addRigidBody(body.get(), 1, k_all);
        return body;
    }

    BodyPtr make_kinematic(const Pose& pose) {
        BodyPtr body = make_body(0.0, Vec3::Zero(), pose, add_shape(new btEmptyShape));
        body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        world.addRigidBody(body.get(), 0, 0);
        return body;
    }

    btRigidBody& body_of(int index) {
        return index == k_world ? *ground : *bodies[static_cast<std::size_t>(index)];
    }

    std::unique_ptr<btTypedConstraint> make_joint(const LabJoint& joint) {
        btRigidBody& a = body_of(joint.a);
        btRigidBody& b = body_of(joint.b);
        switch (joint.kind) {
            case JointKind::hinge: {
                auto hinge = std::make_unique<btHingeConstraint>(a, b, hinge_frame(joint.frame_a),
                                                                 hinge_frame(joint.frame_b));
                if (joint.limited) {
                    hinge->setLimit(joint.lower, joint.upper);
                }
                return hinge;
            }
            case JointKind::slider: {
                auto slider = std::make_unique<btSliderConstraint>(a, b, to_bullet(joint.frame_a),
                                                                   to_bullet(joint.frame_b), true);
                slider->setLowerLinLimit(joint.lower);
                slider->setUpperLinLimit(joint.upper);
                slider->setLowerAngLimit(0.0);
                slider->setUpperAngLimit(0.0);
                return slider;
            }
            case JointKind::fixed:
                return std::make_unique<btFixedConstraint>(a, b, to_bullet(joint.frame_a),
                                                           to_bullet(joint.frame_b));
            case JointKind::ball:
            case JointKind::distance:
                break;
        }
        return std::make_unique<btPoint2PointConstraint>(a, b, to_bullet(joint.frame_a.position),
                                                         to_bullet(joint.frame_b.position));
    }

    Pose hand_ws(const LabHold& hold, double at_s) const {
        const Vec3& origin = scene.players[static_cast<std::size_t>(hold.player)].origin_ws;
        return Pose{origin, Quat::Identity()} * hold.hand_ps(at_s);
    }
    // The hand's pose in the frame of the body that carries it: the player, or the kinematic body
    // that is the hand.
    Pose hand_in_carrier(const LabHold& hold, double at_s) const {
        return holder == Holder::player ? hold.hand_ps(at_s) : Pose{};
    }
    Pose anchor_of(const LabHold& hold) const {
        const Pose& body = scene.bodies[static_cast<std::size_t>(hold.body)].pose_ws;
        return {hold.anchor_bs, body.rotation.conjugate() * hold.hand_ps(0.0).rotation};
    }

    std::unique_ptr<btTypedConstraint> make_grab(std::size_t index) {
        const LabHold& hold = scene.holds[index];
        const std::size_t carrier =
            holder == Holder::player ? static_cast<std::size_t>(hold.player) : index;
        btRigidBody& a = *bodies[scene.bodies.size() + carrier];
        btRigidBody& b = body_of(hold.body);
        const Pose hand = hand_in_carrier(hold, 0.0);
        if (hold.point_only) {
            return std::make_unique<btPoint2PointConstraint>(a, b, to_bullet(hand.position),
                                                             to_bullet(hold.anchor_bs));
        }
        return std::make_unique<btFixedConstraint>(a, b, to_bullet(hand),
                                                   to_bullet(anchor_of(hold)));
    }

    void move_hands() {
        for (std::size_t i = 0; i < scene.holds.size(); ++i) {
            const LabHold& hold = scene.holds[i];
            if (holder == Holder::kinematic) {
                bodies[scene.bodies.size() + i]->getMotionState()->setWorldTransform(
                    to_bullet(hand_ws(hold, t_s)));
            }
            if (grabs[i] != nullptr && t_s >= hold.release_s) {
                world.removeConstraint(grabs[i].get());
                grabs[i].reset();
            }
            if (grabs[i] == nullptr || holder == Holder::kinematic) {
                continue;
            }
            const Pose hand = hold.hand_ps(t_s);
            if (hold.point_only) {
                static_cast<btPoint2PointConstraint&>(*grabs[i]).setPivotA(
                    to_bullet(hand.position));
            } else {
                static_cast<btFixedConstraint&>(*grabs[i]).setFrames(to_bullet(hand),
                                                                     to_bullet(anchor_of(hold)));
            }
        }
    }

    void step() {
        t_s += dt_s;
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            if (scene.bodies[i].drive) {
                bodies[i]->getMotionState()->setWorldTransform(
                    to_bullet(scene.bodies[i].drive(t_s)));
            }
        }
        move_hands();
        world.stepSimulation(dt_s, 0);
    }

    void read(FrameRecord& record) {
        record.t_s = t_s;
        record.dt_s = dt_s;
        record.poses.clear();
        record.velocities.clear();
        for (const BodyPtr& body : bodies) {
            record.poses.push_back(from_bullet(body->getWorldTransform()));
            record.velocities.push_back(
                {from_bullet(body->getLinearVelocity()), from_bullet(body->getAngularVelocity())});
        }
        record.targets.clear();
        record.held.clear();
        for (std::size_t i = 0; i < scene.holds.size(); ++i) {
            const LabHold& hold = scene.holds[i];
            const std::size_t player = scene.bodies.size() + static_cast<std::size_t>(hold.player);
            record.targets.push_back(holder == Holder::player
                                         ? record.poses[player] * hold.hand_ps(t_s)
                                         : hand_ws(hold, t_s));
            record.held.push_back(grabs[i] != nullptr ? 1 : 0);
        }
        record.iterations = world.getSolverInfo().m_numIterations;
    }
};

BulletRun::BulletRun(const LabScene& scene, Holder holder, double hz)
    : impl_(std::make_unique<Impl>(scene, holder, hz)) {}

BulletRun::~BulletRun() = default;

void BulletRun::set_iterations(int count) { impl_->world.getSolverInfo().m_numIterations = count; }

void BulletRun::step(FrameRecord& record) {
    const std::int64_t begin_ns = stage_now_ns();
    impl_->step();
    record.step_us = 1e-3 * static_cast<double>(stage_now_ns() - begin_ns);
    record.solve_us = record.frame_us = record.step_us;
    impl_->read(record);
}

std::vector<double> bullet_residuals(const LabScene& scene, Holder holder, double hz, int frame) {
    constexpr int k_max_iterations = 50;
    std::vector<double> residuals;
    FrameRecord record;
    for (int iterations = 1; iterations <= k_max_iterations; ++iterations) {
        BulletRun run(scene, holder, hz);
        for (int i = 0; i < frame; ++i) {
            run.step(record);
        }
        run.set_iterations(iterations);
        run.step(record);
        double worst = 0.0;
        for (const LabJoint& joint : scene.joints) {
            worst = std::max(worst, joint_error(joint, record.poses).point_m);
        }
        for (std::size_t i = 0; i < scene.holds.size(); ++i) {
            worst = std::max(worst, grab_error_m(scene.holds[i], record.targets[i], record.poses));
        }
        residuals.push_back(worst);
    }
    return residuals;
}

}  // namespace handhold::lab
