#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/anim/crawler_leg.hpp"
#include "engine/anim/pose_path.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/geometry/shape_library.hpp"
#include "engine/math/math.hpp"

// Rigid bodies: walls, ships, rocks, everything except players. A body's frame has its origin at
// the centre of mass; its axes are the principal axes.
namespace handhold {

enum class BodyKind : std::uint8_t {
    fixed,      // never moves
    kinematic,  // moved by a mover or a MoveTarget; contacts and constraints do not move it
    free,       // moved by its velocity and by constraints
};

// Written by the host that adds the body.
struct RigidBody {
    BodyKind kind = BodyKind::fixed;
    double mass_kg = 0.0;              // > 0 for free bodies; unused otherwise
    Vec3 inertia_kgm2 = Vec3::Zero();  // principal moments, > 0 for free bodies
    double restitution = 0.0;          // [0, 1]; a contact uses the larger of both bodies' values
    double friction = 0.4;  // Coulomb coefficient; a contact uses the geometric mean of both values
};

// True if the body moves with the hand that grips it. Any other body moves the player instead.
// `heavy_body_kg`: PhaseTuning.
inline bool is_light(const RigidBody& body, double heavy_body_kg) {
    return body.kind == BodyKind::free && body.mass_kg < heavy_body_kg;
}

// Current pose. Written first by animate_movers and predict_bodies, later by finish_positions.
struct BodyPose {
    Pose pose_ws;
};
// Pose at the start of the frame. Written by predict_bodies and animate_movers.
struct BodyStart {
    Pose pose_ws;
};
// Velocity of the centre of mass, in the world. Written by animate_movers for kinematic bodies, and
// by pull_bodies, predict_bodies, solve_velocities and limit_velocities for free bodies.
struct BodyVelocity {
    Vec3 linear_mps = Vec3::Zero();
    Vec3 angular_radps = Vec3::Zero();
};

// The body's shape, in the body's frame. A body without a collider has no contacts and cannot be
// gripped. Its joints and existing grips still act.
struct Collider {
    ShapeId shape;
};

// Start pose of the next frame's sweep: the last pose in which the body penetrated nothing. While
// the body penetrates a fixed or kinematic body, the pose moves along with that body. For players,
// the pose of the head's collider. Written by record_valid_poses.
struct LastValidPose {
    Pose pose_ws;
    bool known = true;  // false for a player whose head has not been tracked yet
};

// Moves a kinematic body with constant linear and angular velocity from its pose at time 0. The
// path is a straight line, or a circle or helix if the velocity turns with the body. The pose is
// computed in closed form, so that no error accumulates. Read by animate_movers.
struct Mover {
    Pose start_ws;
    Vec3 velocity_ws_mps = Vec3::Zero();  // velocity at time 0
    Vec3 angular_velocity_ws_radps = Vec3::Zero();
    bool turns_with_body = false;  // true: the velocity is constant in the body's frame
};

// A kinematic body that a host moves: it reaches the pose at the end of the next frame and then
// stays there. A body with a mover has none. Written by move_kinematic and animate_movers.
struct MoveTarget {
    static constexpr std::size_t k_capacity = 8;
    // A frame in which the body moved.
    struct Move {
        double span_s = 0.0;  // since the move before, > 0
        Vec3 moved_m = Vec3::Zero();
        Vec3 turned_rad = Vec3::Zero();  // rotation vector, world
    };

    Pose pose_ws;
    // The last moves, newest first: the body's velocity must not depend on how many frames lie
    // between two poses that the host tells.
    double moved_s = 0.0;     // end of the newest move's frame, s on the world's clock
    std::uint32_t count = 0;  // k_capacity at most
    std::array<Move, k_capacity> moves = {};

    // The moves that are there. Only these are saved, hashed and compared.
    std::span<const Move> kept() const {
        return std::span(moves).first(std::min<std::size_t>(count, k_capacity));
    }
};

// Share of the world's gravity that a free body feels, [-1e3, 1e3]. A body without this component
// feels all of it. Written by the host.
struct GravityScale {
    static constexpr double k_max = 1e3;

    double scale = 1.0;
};

// Which bodies and players' heads collide: two of them only if `layers` of each has a bit in common
// with `mask` of the other. A hand grips a body only if the body's `layers` have a bit in common
// with its player's GrabLayers. Without this component, `layers` is 1 and all bits of `mask` are
// set. Written by the host.
struct CollisionFilter {
    std::uint32_t layers = 1;
    std::uint32_t mask = ~0U;
};

// Moves a kinematic body along a closed path. Read by animate_movers.
struct PathMover {
    PosePath path;
};

// Moves a kinematic body as one bone of a crawling leg. The body is a capsule or box that is
// centred on the bone and has its length along Y. Read by animate_movers.
struct LegMover {
    Entity torso = k_no_entity;  // needs a PathMover; without one the bone does not move
    CrawlerLeg leg;
    CrawlerGait gait;
    LegBone bone = LegBone::upper;
};

}  // namespace handhold
