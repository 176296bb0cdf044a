#pragma once

#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Joints between two bodies: levers, drawers, doors, ropes. Each joint is an entity. Talk row 5.
namespace handhold {

// The kind defines which degrees of freedom are removed. It also defines the joint's coordinate:
// the scalar on which limits, friction, detents and latches act. Below, "points" are the origins of
// frame_a_bs and frame_b_bs, and x_a and x_b are the x axes of those frames (the joint's axis).
enum class JointKind : std::uint8_t {
    ball,    // points coincide; coordinate: angle between x_a and x_b, rad, >= 0 (a cone)
    hinge,   // points and axes coincide; coordinate: rotation of b about x_a, rad
    slider,  // b's point stays on a's axis, without rotation; coordinate: its position along x_a, m
    fixed,   // frames coincide; no coordinate
    distance,  // coordinate: distance of the points, m; lower = upper is a rod, lower = 0 a rope
};

// Locks the joint once its coordinate comes near `at`. Opens if the force on the latch exceeds
// `strength`, or if the handle has moved far enough.
struct JointLatch {
    double at = 0.0;           // coordinate at which the joint is locked, rad or m
    double catch_range = 0.0;  // closes within this distance of `at`, rad or m; 0: no latch
    double strength = 0.0;     // load at which it opens, N or N m; 0: no load does
    Entity handle;             // joint (hinge or slider) that opens the latch; null: none
    double handle_at = 0.0;    // open while |handle's coordinate| is at least this, rad or m
};

enum class MotorKind : std::uint8_t { none, speed, position };

// Drives the coordinate of a hinge or slider with limited force, in the velocity solve, as friction
// acts.
struct JointMotor {
    MotorKind kind = MotorKind::none;
    double speed = 0.0;     // speed: wanted speed of the coordinate, rad/s or m/s
    double position = 0.0;  // position: wanted coordinate, rad or m
    // Position: the joint moves so fast that it would be there after this, s; at least a frame.
    double time_s = 0.1;
    double strength = 0.0;  // largest force, N or N m, >= 0
};

// Written by the host.
struct Joint {
    JointKind kind = JointKind::ball;
    Entity a;  // null: the world
    Entity b;  // never null
    // The joint's frame in each body's frame, or in the world if `a` is null. Its x axis is the
    // joint's axis.
    Pose frame_a_bs;
    Pose frame_b_bs;
    bool collides = false;  // true: the two bodies have contacts with each other
    bool limited = false;   // true: lower and upper apply; distance joints are always limited
    double lower = 0.0;     // limits of the coordinate, rad or m; lower <= upper
    double upper = 0.0;
    // Maximum friction: N along a slider, N m about a hinge or any axis of a ball.
    double friction = 0.0;
    double detent_spacing = 0.0;   // detents lie at multiples of this, rad or m; 0: no detents
    double detent_strength = 0.0;  // maximum force towards the nearest detent, N or N m
    JointLatch latch;
    JointMotor motor;  // replaces the detents while it is on
};

// Written by update_joints.
struct JointState {
    double coordinate = 0.0;  // rad or m; a hinge counts full turns
    double speed = 0.0;       // rad/s or m/s
    bool latched = false;
};

}  // namespace handhold
