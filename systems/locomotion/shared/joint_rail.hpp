#pragma once

#include <optional>

#include "components/body.hpp"
#include "components/joint.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct JointRailIo {
    const Column<RigidBody>& body;          // in
    const Column<Joint>& joint;             // in
    const Column<JointState>& joint_state;  // in: at the frame's start
};

// The one way that a lever, a door or a drawer can go: about its hinge or along its slider. In the
// space (hs) of what holds it and no hand moves: the world, a fixed, kinematic or heavy body.
struct JointRail {
    Entity holder;  // null: the world
    Vec3 point_hs = Vec3::Zero();
    Vec3 axis_hs = Vec3::UnitX();  // unit
    bool turns = false;            // about the axis; else along it
    double back = 0.0;             // how far it can go, rad or m: <= 0
    double ahead = 0.0;            // >= 0
};

// The rail of a light free body. None where no joint holds it, where more than one does, or where
// it is free to go more ways than one (ball, distance).
std::optional<JointRail> find_rail(const JointRailIo& io, Entity body, const PhaseTuning& tuning);

// How far along its rail the body goes when a hand takes a point of it from one place as near to
// another as it can: rad in [-pi, pi] or m, whatever the rail's ends. 0 for a point on the axle.
double travel_along(const JointRail& rail, const Vec3& from_hs, const Vec3& to_hs);

// How much the way of a hand there counts among those of several, as the solver counts it: on a
// hinge by the square of its arm, m^2, since an angle is the less certain the nearer it is to the
// axle.
double weight_along(const JointRail& rail, const Vec3& from_hs);

// A pose that far along the rail, or as far as its ends allow.
Pose moved_along(const JointRail& rail, const Pose& pose_hs, double way);

}  // namespace handhold
