#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// Input from headset and controllers, and what read_tracking makes of it. Play space (_ps) is the
// room that the headset tracks; PlayerOrigin is its pose in the world. Samples are given in the
// device's own space; HeadTracking's shift brings them to play space.
namespace handhold {

enum class HandSide : std::uint8_t { left, right };
inline constexpr std::size_t k_hand_count = 2;
inline constexpr std::size_t index_of(HandSide side) { return static_cast<std::size_t>(side); }

enum class FingerName : std::uint8_t { thumb, index, middle, ring, little };
inline constexpr std::size_t k_finger_count = 5;

// How far each finger is bent, indexed by FingerName: 0 straight, 1 as in a fist.
using FingerCurls = std::array<double, k_finger_count>;
inline constexpr double k_unknown_curl = -1.0;  // the curl is not measured
inline constexpr FingerCurls k_unknown_curls = {k_unknown_curl, k_unknown_curl, k_unknown_curl,
                                                k_unknown_curl, k_unknown_curl};

// One reading of one controller. Not tracked: a pose that is not finite, a rotation that is not of
// unit length, or a position of exactly (0, 0, 0).
struct ControllerSample {
    Pose controller_ps;
    bool grab = false;  // true: the button that closes the hand is pressed
    // How far the button that closes the hand is pressed, [0, 1]. Bends the fingers of an empty
    // hand.
    double squeeze = 0.0;
    // How far the index finger's trigger is pressed, [0, 1]. Bends the index finger of an empty
    // hand, and the fingers of authored grips that follow the trigger.
    double trigger = 0.0;
    bool is_inferred = false;  // true: the runtime guesses the pose, it does not see the device
    // Bends the fingers of an empty hand. A known curl is used instead of squeeze and trigger.
    FingerCurls curls = k_unknown_curls;
};
// Readings of all devices at one time. Input, not state.
struct TrackingSample {
    double t_s = 0.0;                                        // time on the frame clock
    Pose head_ps;                                            // frame between the eyes
    std::array<ControllerSample, k_hand_count> controllers;  // indexed by HandSide
    bool is_head_inferred = false;  // true: the runtime guesses the head's position
};

// Commands from sticks and buttons for one frame. All zero: none.
// Written by read_tracking from the frame's input; read by locomote_players.
struct PlayerCommands {
    double smooth_turn = 0.0;     // [-1, 1], positive turns left
    std::int32_t snap_turns = 0;  // turns to the left begun in this frame; negative to the right
    double brake = 0.0;           // [0, 1]
    // Each component is in [-1, 1]. Used only if LocomotionTuning::thruster_mps2 is above 0.
    Vec3 thrust_ps = Vec3::Zero();
    bool calibrate = false;  // true while the calibration button is held, in a T-pose
};

// Input of one player for one frame.
struct PlayerInput {
    Entity player;
    // Sorted by time: the samples since the end of the last frame and, if known, one after the end
    // of this frame. Poses at the end of the frame are interpolated between the samples before and
    // after it; without a sample after it, they are those of the last sample.
    std::span<const TrackingSample> samples;
    PlayerCommands commands;
};

enum class TrackingState : std::uint8_t {
    never,    // no valid sample yet: the device does not exist
    tracked,  // the last valid sample is not older than TrackingTuning::lost_after_s
    lost,     // the pose is frozen at the last valid one
    // Hands only: the pose follows guesses of the runtime, or is frozen while the hand grips what
    // the player can pull on. Such a hand neither grips nor moves the player.
    inferred,
};

// The head of a player. Written by read_tracking; read by all later stages.
struct HeadTracking {
    Pose pose_ps;    // pose at the end of the frame
    Pose start_ps;   // pose at the start of the frame
    Pose sample_ps;  // last valid sample at or before the end of the frame
    double sample_t_s = 0.0;
    Pose before_ps;  // the valid sample before sample_ps
    double before_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // Correction of samples: pose_ps = (shift_m, shift_turn) * sample. When samples jump
    // (recentring, a tracking error), the correction changes so that the head stays where it was in
    // the world.
    Vec3 shift_m = Vec3::Zero();
    Quat shift_turn = Quat::Identity();  // turn about +Y
    bool is_inferred = false;            // the last sample's position is a guess of the runtime
};

// Whether a jump of head and hands together is taken for a recentring of the device, which must not
// move the player. Players without this component: yes. Written by the host.
struct RecenterGuess {
    // False: the host announces recentrings; in any other jump the player really moved.
    bool guesses = false;
};

enum class GrabEdge : std::uint8_t { none, onset, release };

// One tracked hand: the controller's pose times the pose of the hand in the controller
// (ControllerToHand). Axes as in OpenXR: -Z to the fingers, +Y out of the back of the hand. Written
// by read_tracking.
struct HandTracking {
    Pose pose_ps;    // pose at the end of the frame
    Pose start_ps;   // pose at the start of the frame
    Pose sample_ps;  // last sample that was used
    double sample_t_s = 0.0;
    TrackingState state = TrackingState::never;
    // The pose may have jumped in this frame: the hand was lost in the last one, or came back
    // elsewhere after samples that were ignored or missing. start_ps equals pose_ps then.
    bool resumed = false;
    // Samples after sample_ps were ignored or missing: the next one may lie elsewhere.
    bool interrupted = false;
    // Last valid sample, whether it was used or not. It is newer than sample_ps if it was ignored
    // because the hand would have moved too fast.
    Pose reading_ps;
    double reading_t_s = 0.0;
    double inferred_t_s = 0.0;  // time of the last inferred sample; used in state `inferred`
    // At most one edge per frame and hand. If a button bounces faster, the next frame begins with
    // the next edge.
    GrabEdge edge = GrabEdge::none;
    double edge_t_s = 0.0;                // time of the edge's sample, within the frame
    Pose edge_ps;                         // hand at edge_t_s
    bool pressed = false;                 // state of the grab button after the edge
    bool raw_pressed = false;             // state of the grab button in the last sample
    double squeeze = 0.0;                 // value in the last sample, [0, 1]
    double trigger = 0.0;                 // value in the last sample, [0, 1]
    FingerCurls curls = k_unknown_curls;  // value in the last sample: [0, 1] or k_unknown_curl
    // At a release: velocity of the hand in play space over TrackingTuning::release_window_s.
    Vec3 release_velocity_ps_mps = Vec3::Zero();
    Vec3 release_spin_ps_radps = Vec3::Zero();
};

// A sample later than the end of the last frame.
struct EarlySample {
    double t_s = 0.0;
    Pose head_ps;
    std::array<Pose, k_hand_count> controllers_ps;  // indexed by HandSide
    bool head_tracked = false;                      // false: the pose is invalid
    std::array<bool, k_hand_count> tracked = {};    // indexed by HandSide
    std::array<bool, k_hand_count> grab = {};       // indexed by HandSide
    std::array<double, k_hand_count> squeeze = {};  // indexed by HandSide
    std::array<double, k_hand_count> trigger = {};  // indexed by HandSide
    bool head_inferred = false;
    std::array<bool, k_hand_count> inferred = {};  // indexed by HandSide
    std::array<FingerCurls, k_hand_count> curls = {k_unknown_curls,
                                                   k_unknown_curls};  // indexed by HandSide
};

// A player's samples later than the end of the last frame, as devices that predict poses send them.
// Hosts pass each sample once; it is used in the frame of its time, before that frame's samples.
// Only players with such samples have this component. Written and read by the C interface.
struct EarlySamples {
    static constexpr std::size_t k_capacity = 64;
    std::uint32_t count = 0;                           // number of samples, at most k_capacity
    std::array<EarlySample, k_capacity> samples = {};  // ascending times

    // The samples that are there. Only these are saved, hashed and compared.
    std::span<const EarlySample> kept() const {
        return std::span(samples).first(std::min<std::size_t>(count, k_capacity));
    }
};

// The hand's last samples in a ring, for velocities that do not depend on the frame rate. Written
// by read_tracking.
struct HandHistory {
    static constexpr std::size_t k_capacity = 32;
    struct Entry {
        double t_s = 0.0;
        Pose hand_ps;
    };
    std::array<Entry, k_capacity> entries;
    std::uint32_t next = 0;   // index of the next sample
    std::uint32_t count = 0;  // k_capacity at most
};

}  // namespace handhold
