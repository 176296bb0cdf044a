#pragma once

#include <optional>
#include <span>

#include "systems/frame.hpp"
#include "systems/locomotion/shared/grab_search.hpp"
#include "systems/physics/accept_solution.hpp"

// Frames for hosts with physics of their own. Such a host sets FrameCaches::host_surfaces, and its
// bodies need no colliders.
namespace handhold {

// First half of a frame: intent, prediction and the frame's hand constraints, which are in
// caches.graph.hand_blocks. The host then solves its bodies and players, writes BodyPose and
// BodyVelocity of the bodies that moved, and calls end_host_frame. No other change of the world
// between the two. Throws as step_frame.
void begin_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                      const FrameInput& input, StageStats& stats);

// Second half: releases and limits of velocities, joints, shown hands and bodies, and the clock.
// `input` must be that of begin_host_frame.
void end_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, std::span<const SolvedPlayer> solved,
                    StageStats& stats);

// A whole frame for a host that also moves players itself: it has written PlayerOrigin,
// PlayerVelocity, BodyPose, BodyVelocity and what each hand holds (Grab). Shows hands and bodies.
void show_host_frame(World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats);

// What the hand would grip if it closed where it is: the body and the point of its surface. No
// change of the world. Counts authored grips that are occupied or blocked in `stats`.
std::optional<GrabTarget> find_grip(World& world, FrameCaches& caches, const Tuning& tuning,
                                    Entity hand, StageStats& stats);

}  // namespace handhold
