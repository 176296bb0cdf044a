#pragma once

#include <array>
#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// A player is simulated as the translation of their play space: three degrees of freedom. Head and
// hands lie at tracked offsets from its origin. These offsets are input; the simulation never
// changes them.
namespace handhold {

// Written by the host that adds the player.
struct PlayerBody {
    double mass_kg = 80.0;  // > 0
};

// Pose of the play space in the world. predict_bodies and finish_positions write the position. Only
// locomote_players writes the rotation (turn commands, and following a turning support).
struct PlayerOrigin {
    Pose pose_ws;
};
// Pose of the play space at the start of the frame. Written by predict_bodies.
struct PlayerStart {
    Pose pose_ws;
};
// Velocity of the play space, in the world. Does not include motion of the head within the play
// space. Written by locomote_players and update_velocities.
struct PlayerVelocity {
    Vec3 linear_mps = Vec3::Zero();
};

// The velocity relative to which the player's drag, brake and release clamp act. It is the velocity
// of the body last gripped, at the gripped point, or else the scene's
// (World::reference_velocity_mps). Written by locomote_players.
struct ReferenceVelocity {
    Vec3 linear_mps = Vec3::Zero();
    Entity body = k_no_entity;  // the body last gripped; null: none
    // The gripped point: a turning body's velocity is evaluated there.
    Vec3 point_bs = Vec3::Zero();
};

// Bodies that this player's head passes through: bodies in their hands, and released bodies that
// have not yet left the head's collider. update_grabs adds bodies; find_contacts removes them. When
// the list is full, its elements are overwritten in turn.
struct HeadIgnores {
    static constexpr std::size_t k_capacity = 8;
    std::array<Entity, k_capacity> bodies;  // null: unused element
    std::uint32_t next = 0;                 // element to overwrite next when full
};

}  // namespace handhold
