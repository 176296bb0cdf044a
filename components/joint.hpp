#pragma once

#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// What ties two bodies together: levers, drawers, doors, ropes. A joint is an entity of its own.
// Talk row 5.
namespace handhold {

// A joint's coordinate is its one free number that limits, friction, detents and latches act on.
enum class JointKind : std::uint8_t {
    ball,      // points together; coordinate: angle between the axes, rad (a cone: 0 is straight)
    hinge,     // and axes along each other; coordinate: turn of b against a about the axis, rad
    slider,    // b's point on a's axis, no turning; coordinate: way of b's point along it, m
    fixed,     // frames together; no coordinate
    distance,  // the points' distance is the coordinate, m: lower = upper a rod, lower = 0 a rope
};

// Holds the coordinate where it is caught. It opens when the force on it is too strong, or when
// another joint (the handle) has gone far enough. It holds nothing where `catch_range` is 0.
struct JointLatch {
    double at = 0.0;           // coordinate, rad or m
    double catch_range = 0.0;  // closes when the coordinate comes this near to it
    double strength = 0.0;     // opens above this force, N or N m; 0: no force opens it
    Entity handle;             // a hinge or slider; null: none
    double handle_at = 0.0;    // open while the handle's coordinate is at least this far from 0
};

// Written by whoever makes the joint.
struct Joint {
    JointKind kind = JointKind::ball;
    Entity a;         // null: the world
    Entity b;         // a body
    Pose frame_a_bs;  // the joint's frame in each body's frame (a null: in the world); its axis is
    Pose frame_b_bs;  // the frame's local x
    bool collides = false;  // the two bodies touch each other
    bool limited = false;   // distance: always
    double lower = 0.0;     // of the coordinate; not above `upper`
    double upper = 0.0;
    double friction = 0.0;         // N along a slider, N m about a hinge or any axis of a ball
    double detent_spacing = 0.0;   // rad or m: rests at each multiple of it; 0: none
    double detent_strength = 0.0;  // N or N m that hold it there
    JointLatch latch;
};

// Written by update_joints.
struct JointState {
    double coordinate = 0.0;  // rad or m; a hinge's goes on counting over whole turns
    double speed = 0.0;       // its rate
    bool latched = false;
};

}  // namespace handhold
