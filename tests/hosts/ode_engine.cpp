// The engine's own part: boxes, hinges, driven bodies, contacts and the step.
#include "ode_engine.hpp"

#include <cmath>

namespace host {
namespace {

struct Contacts {
    dWorldID world;
    dJointGroupID group;
};

void collide(void* data, dGeomID a, dGeomID b) {
    const Contacts& contacts = *static_cast<const Contacts*>(data);
    const dBodyID body_a = dGeomGetBody(a);
    const dBodyID body_b = dGeomGetBody(b);
    const bool can_move = (body_a != nullptr && !dBodyIsKinematic(body_a)) ||
                          (body_b != nullptr && !dBodyIsKinematic(body_b));
    if (!can_move || (body_a != nullptr && body_b != nullptr &&
                      dAreConnectedExcluding(body_a, body_b, dJointTypeContact) != 0)) {
        return;
    }
    constexpr int k_points = 8;
    dContact points[k_points];
    const int count = dCollide(a, b, k_points, &points[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
        points[i].surface.mode = dContactApprox1;
        points[i].surface.mu = 0.5;
        dJointAttach(dJointCreateContact(contacts.world, contacts.group, &points[i]), body_a,
                     body_b);
    }
}

}  // namespace

hh::Pose Box::pose() const {
    const dReal* const p = dGeomGetPosition(geom);
    dQuaternion q;  // w first
    dGeomGetQuaternion(geom, q);
    return {{p[0], p[1], p[2]}, {q[1], q[2], q[3], q[0]}};
}

Engine::Engine() {
    dInitODE2(0);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetERP(world_, 0.8);
    dWorldSetCFM(world_, 1e-12);
}

Engine::~Engine() {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
}

std::size_t Engine::add_box(Kind kind, hh::Vec3 half_m, hh::Pose pose, double mass_kg) {
    Box box;
    box.kind = kind;
    box.half_m = half_m;
    box.geom = dCreateBox(space_, 2.0 * half_m.x, 2.0 * half_m.y, 2.0 * half_m.z);
    if (kind != Kind::fixed) {
        box.body = dBodyCreate(world_);
        dMass mass;
        dMassSetBoxTotal(&mass, mass_kg, 2.0 * half_m.x, 2.0 * half_m.y, 2.0 * half_m.z);
        dBodySetMass(box.body, &mass);
        dBodySetFiniteRotationMode(box.body, 1);
        dGeomSetBody(box.geom, box.body);
        if (kind == Kind::driven) {
            dBodySetKinematic(box.body);
        }
    }
    dGeomSetPosition(box.geom, pose.position.x, pose.position.y, pose.position.z);
    const dQuaternion q = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
    dGeomSetQuaternion(box.geom, q);
    boxes_.push_back(box);
    return boxes_.size() - 1;
}

void Engine::add_hinge(std::size_t box, hh::Vec3 point, double low_rad, double high_rad) {
    const dJointID joint = dJointCreateHinge(world_, nullptr);
    dJointAttach(joint, boxes_[box].body, nullptr);
    dJointSetHingeAnchor(joint, point.x, point.y, point.z);
    dJointSetHingeAxis(joint, 0.0, 1.0, 0.0);
    dJointSetHingeParam(joint, dParamLoStop, low_rad);
    dJointSetHingeParam(joint, dParamHiStop, high_rad);
}

void Engine::drive(std::size_t box, hh::Pose end, double dt_s) {
    const hh::Pose now = boxes_[box].pose();
    const hh::Vec3 v = (1.0 / dt_s) * (end.position - now.position);
    const hh::Quat turn = multiply(end.rotation, conjugate(now.rotation));
    const hh::Vec3 axis{turn.x, turn.y, turn.z};
    const double sine = length(axis);
    const double angle = 2.0 * std::atan2(sine, turn.w);
    const hh::Vec3 w = sine > 0.0 ? (angle / (sine * dt_s)) * axis : hh::Vec3{};
    dBodySetLinearVel(boxes_[box].body, v.x, v.y, v.z);
    dBodySetAngularVel(boxes_[box].body, w.x, w.y, w.z);
    driven_.push_back({box, end});
}

void Engine::step(double dt_s) {
    Contacts contacts{world_, contacts_};
    dSpaceCollide(space_, &contacts, &collide);
    dWorldStep(world_, dt_s);
    dJointGroupEmpty(contacts_);
    for (const Driven& driven : driven_) {  // to the bit, and at rest until it is driven again
        set_motion(driven.box, driven.end, {}, {});
    }
    driven_.clear();
}

hh::Vec3 Engine::velocity(std::size_t box) const {
    const dReal* const v = dBodyGetLinearVel(boxes_[box].body);
    return {v[0], v[1], v[2]};
}

void Engine::set_kinematic(std::size_t box, bool is_kinematic) {
    if (is_kinematic) {
        dBodySetKinematic(boxes_[box].body);
    } else {
        dBodySetDynamic(boxes_[box].body);
    }
}

void Engine::set_motion(std::size_t box, hh::Pose pose, hh::Vec3 velocity, hh::Vec3 spin) {
    const dBodyID body = boxes_[box].body;
    const dQuaternion q = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
    dBodySetPosition(body, pose.position.x, pose.position.y, pose.position.z);
    dBodySetQuaternion(body, q);
    dBodySetLinearVel(body, velocity.x, velocity.y, velocity.z);
    dBodySetAngularVel(body, spin.x, spin.y, spin.z);
}

}  // namespace host
