#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Tracking input, and the head and hand poses that read_tracking derives from it. Play space (_ps)
// is the frame of the tracking system, shifted by HeadTracking::shift_m; its pose in the world is
// PlayerOrigin. Poses in TrackingSample are not shifted yet.
namespace handhold {

enum class HandSide : std::uint8_t { left, right };
inline constexpr std::size_t k_hand_count = 2;
inline constexpr std::size_t index_of(HandSide side) { return static_cast<std::size_t>(side); }

// One reading of one controller. If its pose is not finite, or its rotation does not have unit
// length, the controller counts as not tracked.
struct ControllerSample {
    Pose controller_ps;
    bool grab = false;  // the button that closes the hand is pressed
};
// Readings of all devices at one time. Input, not state.
struct TrackingSample {
    double t_s = 0.0;                                        // time on the frame clock
    Pose head_ps;                                            // frame between the eyes
    std::array<ControllerSample, k_hand_count> controllers;  // by HandSide
};

// Commands that the player gives with sticks and buttons. All zero: no command. Written by
// read_tracking from the frame's input; read by locomote_players and calibrate_players.
struct PlayerCommands {
    double smooth_turn = 0.0;  // [-1, 1], positive turns left
    // Turns to the left that begin in this frame; negative: to the right.
    std::int32_t snap_turns = 0;
    double brake = 0.0;  // [0, 1]
    // Components in [-1, 1]; ignored if LocomotionTuning::thruster_mps2 is 0.
    Vec3 thrust_ps = Vec3::Zero();
    bool calibrate = false;  // true while the player holds a T-pose to be measured
};

// Input of one player for one frame.
struct PlayerInput {
    Entity player;
    // Sorted by time: the samples since the end of the last frame. If a sample after the end of
    // this frame is known, it comes last; poses are then interpolated to the frame's end. Otherwise
    // the last pose is held.
    std::span<const TrackingSample> samples;
    PlayerCommands commands;
};

enum class TrackingState : std::uint8_t {
    never,    // no valid sample yet: the device does not exist
    tracked,  // the last valid sample is not older than TrackingTuning::lost_after_s
    lost,     // the pose is frozen
};

// A player's head. Written by read_tracking.
struct HeadTracking {
    Pose pose_ps;    // at the end of the frame
    Pose start_ps;   // at the start of the frame
    Pose sample_ps;  // last valid sample at or before the end of the frame
    double sample_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // Added to every tracked position. Changes when the head jumps (re-centring, a glitch), so that
    // the head does not move.
    Vec3 shift_m = Vec3::Zero();
};

enum class GrabEdge : std::uint8_t { none, onset, release };

// One tracked hand: the controller's pose times the pose of the hand in the controller
// (ControllerToHand). Axes as in OpenXR: -Z to the fingers, +Y out of the back of the hand. Written
// by read_tracking.
struct HandTracking {
    Pose pose_ps;    // at the end of the frame
    Pose start_ps;   // at the start of the frame
    Pose sample_ps;  // last valid sample at or before the end of the frame
    double sample_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // The pose may have jumped: the hand is tracked now but was lost in the last frame, or two
    // successive samples lie farther apart than TrackingTuning::max_jump_m.
    bool resumed = false;
    // Change of `pressed` in this frame: at most one. If the button changes more often, the next
    // frame begins with the next edge.
    GrabEdge edge = GrabEdge::none;
    double edge_t_s = 0.0;     // time of the edge's sample, within the frame
    Pose edge_ps;              // pose of the hand at the edge
    bool pressed = false;      // grab button after the edge
    bool raw_pressed = false;  // grab button in the last sample
    // Velocities of the hand in play space at its last release: least-squares slopes over the
    // samples of the last TrackingTuning::release_window_s seconds.
    Vec3 release_velocity_ps_mps = Vec3::Zero();
    Vec3 release_spin_ps_radps = Vec3::Zero();
};

// Ring buffer of the hand's last samples. Release velocities are measured from it, so that they do
// not depend on the frame rate. Written by read_tracking.
struct HandHistory {
    static constexpr std::size_t k_capacity = 32;
    struct Entry {
        double t_s = 0.0;
        Pose hand_ps;
    };
    std::array<Entry, k_capacity> entries;
    std::uint32_t next = 0;   // index that the next sample is written to
    std::uint32_t count = 0;  // at most k_capacity
};

}  // namespace handhold
