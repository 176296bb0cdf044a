#pragma once

#include <optional>
#include <span>

#include "systems/frame/frame.hpp"
#include "systems/grab/shared/grab_search.hpp"
#include "systems/physics/accept_solution.hpp"

// Frames for hosts with their own physics, made of the stages that frame.cpp lists. Such a host
// sets FrameCaches::host_surfaces. Its bodies need no colliders.
namespace handhold {

// First half of a frame: computes intent, prediction and the frame's hand constraints, which are in
// caches.graph.hand_blocks. The host then solves its bodies and players, writes BodyPose and
// BodyVelocity of the bodies that moved, and calls end_host_frame. Nothing else in the world may
// change between the two calls. Throws the same errors as step_frame.
void begin_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                      const FrameInput& input, StageStats& stats);

// Second half of a frame: takes the host's solution, limits velocities and ends released grips.
// Then updates joints, poses the shown hands and bodies, and advances the clock. `input` must be
// the input of begin_host_frame.
void end_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, std::span<const SolvedPlayer> solved,
                    StageStats& stats);

// A whole frame for a host that also moves players itself. Before the call, the host has written
// PlayerOrigin, PlayerVelocity, BodyPose, BodyVelocity, and what each hand holds (Grab). Poses the
// shown hands and bodies, and advances the clock.
void show_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats);

// Returns the body and surface point that the hand would grip if it closed at its present pose.
// Does not change the world. `stats` counts authored grips that are occupied or blocked.
std::optional<GrabTarget> find_grip(World& world, FrameCaches& caches, const Tuning& tuning,
                                    Entity hand, StageStats& stats);

}  // namespace handhold
