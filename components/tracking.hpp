#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// What the headset and the controllers say, and what stage 1 makes of it. Play space (_ps) is the
// frame that the tracking is given in, but for HeadTracking::shift_m, which the readings of an
// input do not have in them yet: it is carried through the world by PlayerOrigin.
namespace handhold {

enum class HandSide : std::uint8_t { left, right };
inline constexpr std::size_t k_hand_count = 2;
inline constexpr std::size_t index_of(HandSide side) { return static_cast<std::size_t>(side); }

// One reading of one device. A pose that is not finite, or whose rotation is not of unit length,
// says: not tracked.
struct ControllerSample {
    Pose controller_ps;
    bool grab = false;  // a button that closes the hand is down
};
// One reading of all devices at one time. Input, not state.
struct TrackingSample {
    double t_s = 0.0;                                        // on the frame clock
    Pose head_ps;                                            // between the eyes
    std::array<ControllerSample, k_hand_count> controllers;  // by HandSide
};

// What the player asks for with sticks and buttons. All zero: nothing.
// Written by read_tracking from the frame's input; read by locomote_players.
struct PlayerCommands {
    double smooth_turn = 0.0;       // [-1, 1], positive turns left
    std::int32_t snap_turns = 0;    // turns to the left begun in this frame; negative to the right
    double brake = 0.0;             // [0, 1]
    Vec3 thrust_ps = Vec3::Zero();  // each in [-1, 1]; obeyed only where Tuning allows thrusters
    bool calibrate = false;         // held while he holds a T-pose
};

// The frame's input of one player.
struct PlayerInput {
    Entity player;
    // Sorted by time: those since the last frame's end, and, where known, one after this frame's
    // end: poses are then interpolated to the frame's end instead of being held.
    std::span<const TrackingSample> samples;
    PlayerCommands commands;
};

enum class TrackingState : std::uint8_t {
    never,    // no valid sample yet: the device does not exist
    tracked,  // a valid sample, not older than TrackingTuning::lost_after_s
    lost,     // the pose is frozen at the last valid one
};

// The head of a player. Written by read_tracking; read by everything after it.
struct HeadTracking {
    Pose pose_ps;    // at the end of the frame
    Pose start_ps;   // at its start
    Pose sample_ps;  // last valid sample at or before the end of the frame
    double sample_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // Added to every position that the tracking gives, so that a head that jumps (re-centring, a
    // glitch) stays where it was in the world.
    Vec3 shift_m = Vec3::Zero();
};

enum class GrabEdge : std::uint8_t { none, onset, release };

// One hand: the controller's pose after the controller-to-hand joint (OpenXR wrist axes: -Z to the
// fingers, +Y the back of the hand). Written by read_tracking.
struct HandTracking {
    Pose pose_ps;   // at the end of the frame
    Pose start_ps;  // at its start
    Pose sample_ps;
    double sample_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // Tracked in this frame, and lost in the last one, or a sample was farther than
    // TrackingTuning::max_jump_m from the one before: the pose may have jumped.
    bool resumed = false;
    // At most one edge a frame and hand; where buttons bounce faster the next frame begins with the
    // next edge.
    GrabEdge edge = GrabEdge::none;
    double edge_t_s = 0.0;     // the sample's own time, within the frame
    Pose edge_ps;              // the hand then
    bool pressed = false;      // after the edge
    bool raw_pressed = false;  // what the last sample said
    // At a release: slopes over the last samples (TrackingTuning::release_window_s), of the hand in
    // play space.
    Vec3 release_velocity_ps_mps = Vec3::Zero();
    Vec3 release_spin_ps_radps = Vec3::Zero();
};

// A player's sample of after the last frame's end, for hosts that give each sample once: it comes
// before the next frame's samples. Only players with such a sample have this component. Written and
// read by the C interface.
struct EarlySample {
    double t_s = 0.0;
    Pose head_ps;
    std::array<Pose, k_hand_count> controllers_ps;  // by HandSide
    bool head_tracked = false;                      // false: the pose says nothing
    std::array<bool, k_hand_count> tracked = {};    // by HandSide
    std::array<bool, k_hand_count> grab = {};       // by HandSide
};

// The hand's last samples, oldest overwritten first, for velocities that do not depend on the frame
// rate. Written by read_tracking.
struct HandHistory {
    static constexpr std::size_t k_capacity = 32;
    struct Entry {
        double t_s = 0.0;
        Pose hand_ps;
    };
    std::array<Entry, k_capacity> entries;
    std::uint32_t next = 0;   // where the next sample goes
    std::uint32_t count = 0;  // at most k_capacity
};

}  // namespace handhold
