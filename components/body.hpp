#pragma once

#include <cstdint>

#include "engine/anim/crawler_leg.hpp"
#include "engine/anim/pose_path.hpp"
#include "engine/collision/shape_library.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Everything that is not a player: walls, ships, rocks. A body's frame sits at its centre of mass,
// its axes are principal.
namespace handhold {

enum class BodyKind : std::uint8_t {
    fixed,      // never moves
    kinematic,  // moves as it is told and is moved by nothing (Mover)
    free,       // moved by velocities and constraints
};

// Written by whoever makes the body.
struct RigidBody {
    BodyKind kind = BodyKind::fixed;
    double mass_kg = 0.0;              // free: > 0; else unused
    Vec3 inertia_kgm2 = Vec3::Zero();  // free: principal moments, > 0
    double restitution = 0.0;          // [0, 1]; the larger of two bodies' counts
    double friction = 0.4;             // Coulomb's coefficient; of two bodies the geometric mean
};

// Where a body is. Written by animate_movers and predict_bodies, then finish_positions.
struct BodyPose {
    Pose pose_ws;
};
// Where it was at the start of the frame. Written by predict_bodies and animate_movers.
struct BodyStart {
    Pose pose_ws;
};
// Of the centre of mass, in the world. Written by animate_movers (kinematic) and update_velocities
// (free).
struct BodyVelocity {
    Vec3 linear_mps = Vec3::Zero();
    Vec3 angular_radps = Vec3::Zero();
};

// The body's shape, in the body's frame. Without one nothing touches it and no hand finds it;
// joints and grips that are there act on it all the same.
struct Collider {
    ShapeId shape;
};

// The pose from which the next frame is swept: the last one in which the collider did not overlap
// anything it should not. Players have one too: their head's centre. Written by update_velocities.
struct LastValidPose {
    Pose pose_ws;
    bool known = true;  // false: not anywhere yet; a player whose head has not been tracked
};

// A kinematic body's constant twist from its pose at time 0: straight on, spinning, or, where the
// velocity turns with the body, along a circle or a helix. In closed form of the time: nothing
// accumulates. Read by animate_movers.
struct Mover {
    Pose start_ws;
    Vec3 velocity_ws_mps = Vec3::Zero();  // at time 0
    Vec3 angular_velocity_ws_radps = Vec3::Zero();
    bool turns_with_body = false;  // the velocity keeps its direction in the body's frame
};

// A kinematic body that goes round a closed path. Read by animate_movers, also for the legs of the
// body.
struct PathMover {
    PosePath path;
};

// A kinematic body that is one bone of a crawling leg: a capsule or box about the bone's middle
// with its length along Y. Read by animate_movers.
struct LegMover {
    Entity torso = k_no_entity;  // has a PathMover; without one the bone stays where it is
    CrawlerLeg leg;
    CrawlerGait gait;
    LegBone bone = LegBone::upper;
};

}  // namespace handhold
