#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Largest numbers that a frame may end with, in each coordinate.
inline constexpr double k_farthest_result_m = 1e12;
inline constexpr double k_fastest_result = 1e9;  // m/s or rad/s

struct DiscardBrokenResultsIo {
    const Column<BodyStart>& body_start;      // in
    const Column<PlayerStart>& player_start;  // in
    Column<BodyPose>& body_pose;              // in/out
    Column<BodyVelocity>& body_velocity;      // in/out
    Column<PlayerOrigin>& player_origin;      // in/out
    Column<PlayerVelocity>& player_velocity;  // in/out
    Column<LastValidPose>& last_valid;        // in/out
    Column<JointState>& joint_state;          // in/out
    Column<Grab>& grab;                       // in/out
    FrameGraph& frame;                        // in/out: push_backs
};

// Discards results of solves that overflowed because of extreme masses, moments or distances (for
// instance 1e-12 to 1e15 kg in one chain). A body or player whose pose is invalid or beyond
// k_farthest_result_m, or whose velocity is not finite or beyond k_fastest_result, returns to its
// pose at the start of the frame, at rest, and is counted as restored_last_valid_pose. An invalid
// last valid pose becomes the present pose; other invalid numbers become 0. So no frame begins with
// such a number, and no snapshot contains one.
void discard_broken_results(const DiscardBrokenResultsIo& io, StageStats& stats);

}  // namespace handhold
