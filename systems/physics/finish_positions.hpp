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
// A free body that penetrates by contact.restore_depth_m or more is restored if its last valid pose
// is less than k_max_restore_distance_m away and at least halves its error. So a hand that jumps
// through clutter carries no body into a wall. Free bodies and heads that a restored body overlaps
// are restored too.
// Overlaps without contacts, of bodies that moved farther than sweeps cover (find_missed_overlaps),
// count too, and a pose with such an overlap does not become the last valid pose. A restored body
// that penetrated a fixed or kinematic body is carried along with it, and enters the velocity solve
// at the velocity of that body. The penetrating bodies of one island are restored together or not
// at all. A player whose head was stuck in a fixed or kinematic body leaves it at k_head_eject_mps
// times the player's scale at most.
// Fallbacks counted: restored_last_valid_pose (per island), contacts_unresolved (also of a head on
// its way out), pairs_deferred, solver_budget (heaps so large that nothing is restored).
namespace handhold {

// Largest speed at which a player of scale 1 who is stuck in a wall is pushed out of it.
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
