#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

// Restores bodies that still penetrate to their last valid pose, then writes poses and errors.
// Runs after solve_phases.
//
// A free body that penetrates by contact.restore_depth_m or more is restored, less than
// k_max_restore_distance_m far, if that at least halves its error: a hand that jumps through
// clutter carries no body into a wall. Free bodies and heads that it overlaps there are restored
// with it.
// Overlaps that its contacts do not show, because it moved farther than sweeps cover
// (find_missed_overlaps), count too; such a pose does not become the last valid one. A body
// restored next to a fixed or kinematic body moves with it and enters the velocity solve at its
// velocity. The penetrating bodies of one island are restored together or not at all. A player
// whose head was stuck in a fixed or kinematic body leaves it at k_head_eject_mps at most.
// Fallbacks counted: restored_last_valid_pose (per island), contacts_unresolved (also of a head on
// its way out), pairs_deferred, solver_budget (heaps so large that nothing is restored).
namespace handhold {

// Largest speed at which a player who is stuck in a wall is pushed out of it.
inline constexpr double k_head_eject_mps = 3.0;

struct FinishPositionsIo {
    double dt_s;                                    // in: s
    const Column<HeadTracking>& head;               // in: play space
    const Column<PlayerVelocity>& player_velocity;  // in: world, m/s, start of the frame
    CollisionWorld& collision;                      // in/out: proxies of restored bodies, world
    FrameGraph& frame;                              // in/out: graph, contacts; out: push_backs
    Column<BodyPose>& body_pose;                    // out, free bodies: world, end of the frame
    Column<PlayerOrigin>& origin;                   // out: world, position only
    Column<Grab>& grab;                             // out: error_m, m
};
void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning,
                      const HeadTuning& head, StageStats& stats);

}  // namespace handhold
