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
// What a hand releases gets the hand's release velocity, like after solve_velocities: a solver's
// velocity also contains its position corrections. This applies to a hand that let go of a surface
// or of a body that it alone held without joints to something immovable, and only if the hand was
// within k_follows_m of its anchor at the end of the frame. Otherwise something stopped the body,
// and the host's velocity is kept. Fallbacks counted: none.
namespace handhold {

// A hand that is farther from its anchor did not follow it.
inline constexpr double k_follows_m = 1e-3;

// A player's play space after a host's solver. The solver does not rotate it.
struct SolvedPlayer {
    Entity player;
    Vec3 origin_ws = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();
};

struct AcceptSolutionIo {
    std::span<const SolvedPlayer> players;  // in: players without one move as predicted
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
