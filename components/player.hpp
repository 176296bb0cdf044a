#pragma once

#include <array>
#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// A player is the translation of his play space: three degrees of freedom. Head and hands sit at
// tracked offsets, which are input: nothing ever fights the headset.
namespace handhold {

// Written by whoever makes the player.
struct PlayerBody {
    double mass_kg = 80.0;  // > 0
};

// The play space in the world. The position is moved by predict_bodies and finish_positions, the
// rotation by locomote_players only (turning, following a support).
struct PlayerOrigin {
    Pose pose_ws;
};
// The same at the start of the frame. Written by predict_bodies.
struct PlayerStart {
    Pose pose_ws;
};
// Of the play space. The head's own tracked motion does not count. Written by locomote_players,
// update_velocities.
struct PlayerVelocity {
    Vec3 linear_mps = Vec3::Zero();
};

// What drags, brakes and clamps count as standing still: the velocity of the body last gripped, at
// the point of the grip, else the scene's. Written by locomote_players.
struct ReferenceVelocity {
    Vec3 linear_mps = Vec3::Zero();
    Entity body = k_no_entity;     // last gripped
    Vec3 point_bs = Vec3::Zero();  // where: a turning body's velocity is taken there
};

// Bodies that the head passes through: those in this player's hands, and those let go until they
// are apart from the head. Added by update_grabs, dropped by find_contacts. When full, places are
// overwritten in turn.
struct HeadIgnores {
    static constexpr std::size_t k_capacity = 8;
    std::array<Entity, k_capacity> bodies;  // null: unused
    std::uint32_t next = 0;                 // to be overwritten when full
};

}  // namespace handhold
