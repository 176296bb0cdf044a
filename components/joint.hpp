#pragma once

#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Joints between two bodies: levers, drawers, doors, ropes. A joint is an entity of its own.
// Talk row 5.
namespace handhold {

// The kind defines which degrees of freedom are removed, and the joint's coordinate: the scalar
// that limits, friction, detents and latches act on. x_a, x_b: the frames' local x axes, the
// joint's axis.
enum class JointKind : std::uint8_t {
    ball,      // points coincide; coordinate: angle between x_a and x_b, rad, >= 0 (a cone)
    hinge,     // points and axes coincide; coordinate: rotation of b relative to a about x, rad
    slider,    // b's point on a's axis, no rotation; coordinate: position of b's point along x_a, m
    fixed,     // frames coincide; no coordinate
    distance,  // coordinate: the points' distance, m; lower = upper: a rod, lower = 0: a rope
};

// Locks the coordinate once it comes near `at`. Opens if the force on it exceeds `strength`, or
// when a handle's coordinate has moved far enough.
struct JointLatch {
    double at = 0.0;           // coordinate at which it locks, rad or m
    double catch_range = 0.0;  // closes within this distance of `at`, rad or m; 0: no latch
    double strength = 0.0;     // opens above this force, N or N m; 0: never by force
    Entity handle;             // joint (hinge or slider) that opens it; null: none
    double handle_at = 0.0;    // open while |handle's coordinate| is at least this, rad or m
};

// Written by the host.
struct Joint {
    JointKind kind = JointKind::ball;
    Entity a;  // null: the world
    Entity b;  // a body
    // The joint's frame in each body's frame (a null: in the world); its local x is the axis.
    Pose frame_a_bs;
    Pose frame_b_bs;
    bool collides = false;  // true: contacts between the two bodies are not suppressed
    bool limited = false;   // true: lower and upper apply; distance joints are always limited
    double lower = 0.0;     // of the coordinate, rad or m; lower <= upper
    double upper = 0.0;
    // Maximum friction: N along a slider, N m about a hinge or any axis of a ball.
    double friction = 0.0;
    double detent_spacing = 0.0;   // a rest position at each multiple, rad or m; 0: none
    double detent_strength = 0.0;  // maximum force towards the rest position, N or N m
    JointLatch latch;
};

// Written by update_joints.
struct JointState {
    double coordinate = 0.0;  // rad or m; a hinge counts full turns
    double speed = 0.0;       // rad/s or m/s
    bool latched = false;
};

}  // namespace handhold
