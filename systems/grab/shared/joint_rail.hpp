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

// The single degree of freedom of a lever, a door or a drawer: about its hinge or along its slider.
// Given in the space (_hs) of its holder, which no hand moves: the world, or a fixed, kinematic or
// heavy body.
struct JointRail {
    Entity holder;  // null: the world
    Vec3 point_hs = Vec3::Zero();
    Vec3 axis_hs = Vec3::UnitX();  // unit
    bool turns = false;            // true: turns about the axis; false: slides along it
    double back = 0.0;             // lowest travel, rad or m, <= 0
    double ahead = 0.0;            // highest travel, >= 0
};

// The rail of a light free body: its only joint to something that no hand moves, a hinge or a
// slider. None if there is no such joint, more than one, or one of another kind. Joints to other
// light free bodies do not count.
std::optional<JointRail> find_rail(const JointRailIo& io, Entity body, const PhaseTuning& tuning);

// Travel of the body along its rail when a hand takes one of its points as close to `to_hs` as the
// rail allows: rad in [-pi, pi] or m. The rail's ends are not applied. 0 for a point on the axis.
double travel_along(const JointRail& rail, const Vec3& from_hs, const Vec3& to_hs);

// Weight of a hand's travel in the mean over several hands, equal to its weight in the solver: on a
// hinge the square of the lever arm, m^2; on a slider 1.
double weight_along(const JointRail& rail, const Vec3& from_hs);

// The pose moved by `travel` along the rail, clamped to its ends.
Pose moved_along(const JointRail& rail, const Pose& pose_hs, double travel);

}  // namespace handhold
