#pragma once

#include <array>
#include <cstdint>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// A player's only dynamic state is the translation of the play space: three degrees of freedom.
// Head and hands are tracked offsets in it; no constraint acts on them.
namespace handhold {

// Written by the host that adds the player.
struct PlayerBody {
    double mass_kg = 80.0;  // > 0
};

// Pose of the play space in the world. predict_bodies and finish_positions write the position;
// locomote_players writes the rotation (turns, support_follow) and the position that a turn about a
// hand or the head requires.
struct PlayerOrigin {
    static constexpr double k_min_scale = 0.01;
    static constexpr double k_max_scale = 100.0;

    Pose pose_ws;
    // Size of the player, [k_min_scale, k_max_scale]: hands, head, reach and every number of the
    // tuning with TuningInfo::scales are times this. Poses in play space are not: play space has
    // the world's metres. Written by the host that adds the player.
    double scale = 1.0;
};
// Pose of the play space at the start of the frame. Written by predict_bodies.
struct PlayerStart {
    Pose pose_ws;
};
// Velocity of the play space, without the tracked motion of the head in it. Written by pull_bodies,
// locomote_players, solve_velocities and limit_velocities.
struct PlayerVelocity {
    Vec3 linear_mps = Vec3::Zero();
};

// Distance by which contacts moved a player's play space in this frame.
struct PushBack {
    Entity player;
    double distance_m = 0.0;
};

// Velocity relative to which drag, brake and the release clamp act: the velocity of the body last
// gripped, at the gripped point, or the scene's velocity before the first grip. Written by
// locomote_players and, for frames without physics, keep_holds; change_shape moves point_bs to the
// body's new frame, and teleport_player resets it.
struct ReferenceVelocity {
    Vec3 linear_mps = Vec3::Zero();
    Entity body = k_no_entity;     // body last gripped; null: none yet
    Vec3 point_bs = Vec3::Zero();  // point at which the body was gripped
};

// Bodies that do not collide with the player's head: those in the player's hands, and released ones
// until they no longer touch the head. update_grabs adds them, find_contacts removes them. When the
// array is full, the oldest entry is overwritten.
struct HeadIgnores {
    static constexpr std::size_t k_capacity = 8;
    std::array<Entity, k_capacity> bodies;  // null: unused
    std::uint32_t next = 0;                 // index of the entry that is overwritten next
};

}  // namespace handhold
