#pragma once

#include <span>

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "engine/ecs/column.hpp"

// Takes the results of a host's own solver for the frame's hand constraints. Replaces the stages
// from solve_phases to record_valid_poses.
//
// A release happens at the velocity of the hand, as after solve_velocities, because the velocities
// of a host's solver also contain its position corrections. A hand that lets go of a surface sets
// its player's velocity. A hand that lets go of a body sets the body's velocity, if it alone held
// the body and no joints connect the body to something immovable. If the hand was farther than
// k_follows_m from its anchor at the end of the frame, something stopped the body or player, and
// the host's velocity is kept. Fallbacks counted: none.
namespace handhold {

// Largest distance of a hand from its anchor at which the hand counts as having followed it.
inline constexpr double k_follows_m = 1e-3;

// A player's play space after a host's solver. The solver does not rotate it.
struct SolvedPlayer {
    Entity player;
    Vec3 origin_ws = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();
};

struct AcceptSolutionIo {
    std::span<const SolvedPlayer> players;  // in: a player without an element moves as predicted
    const Column<BodyPose>& body_pose;      // in: world, by the host's solver
    Column<BodyVelocity>& body_velocity;    // in/out, thrown bodies: world, m/s and rad/s
    FrameGraph& frame;                      // in/out: graph, phase; out: push_backs
    Column<PlayerOrigin>& origin;           // out: world, position only
    Column<PlayerVelocity>& velocity;       // out: world, m/s
    Column<Grab>& grab;                     // in: phase; out: error_m, m
    Column<LastValidPose>& last_valid;      // out: world
};
// Returns the largest distance of a hand from its anchor, in metres.
double accept_solution(const AcceptSolutionIo& io);

}  // namespace handhold
