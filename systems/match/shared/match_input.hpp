#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "components/tracking.hpp"

// A player's input for one tick of a match, in integers. It is packed once, before anybody uses it:
// every machine, the player's own too, steps with what unpack gives.
namespace handhold {

inline constexpr std::size_t k_most_match_players = 16;

// Position in units of 1 / k_units_per_m. Rotation as the three components of a unit quaternion (x,
// y, z, w) beside the largest one, which is positive; 12 bits each.
struct PackedPose {
    static constexpr double k_units_per_m = 1e4;
    static constexpr std::int32_t k_most_units = (1 << 26) - 1;  // limit of each axis
    static constexpr std::int16_t k_most_rotation = 2047;        // sqrt(1/2)

    std::array<std::int32_t, 3> position{};
    std::uint8_t largest = 3;  // index of the component that is left out
    std::array<std::int16_t, 3> rotation{};

    friend bool operator==(const PackedPose&, const PackedPose&) = default;
};
// True if pack can represent the pose.
bool is_packable(const Pose& pose);
// Precondition: is_packable.
PackedPose pack(const Pose& pose);
Pose unpack(const PackedPose& packed);

struct MatchHand {
    static constexpr std::uint8_t k_unknown_curl = 255;

    PackedPose pose;  // controller at the tick's end; without meaning if it is not tracked
    bool is_tracked = false;
    bool is_inferred = false;  // ControllerSample::is_inferred
    bool grab = false;         // button at the tick's end
    std::uint8_t squeeze = 0;  // unit: 1/255
    std::uint8_t trigger = 0;  // unit: 1/255
    // When the button came to its state at the tick's end, in 1/256 of the tick; 0: at its end, or
    // it did not change. `edge_pose`: the controller then.
    std::uint8_t edge_at = 0;
    PackedPose edge_pose;
    // In 1/254; k_unknown_curl: not measured.
    std::array<std::uint8_t, k_finger_count> curls = {
        k_unknown_curl, k_unknown_curl, k_unknown_curl, k_unknown_curl, k_unknown_curl};

    friend bool operator==(const MatchHand&, const MatchHand&) = default;
};

// The default is the input of a player who is away: no device is tracked, all buttons are up.
struct MatchInput {
    PackedPose head;  // undefined if it is not tracked
    bool is_head_tracked = false;
    bool is_head_inferred = false;
    std::array<MatchHand, k_hand_count> hands;  // indexed by HandSide
    std::int8_t smooth_turn = 0;                // unit: 1/127
    std::int8_t snap_turns = 0;
    std::uint8_t brake = 0;               // unit: 1/255
    std::array<std::int8_t, 3> thrust{};  // unit: 1/127; play space
    bool calibrate = false;
    std::uint32_t buttons = 0;  // bits of the host; the runtime passes them on

    friend bool operator==(const MatchInput&, const MatchInput&) = default;
};

// What read_tracking gets of one tick: the devices at the tick's end, and at the edges of grab
// buttons before it.
struct TickSamples {
    std::array<TrackingSample, 1 + k_hand_count> samples;  // ascending times
    std::size_t count = 0;

    std::span<const TrackingSample> view() const { return std::span(samples).first(count); }
};
// `before`: the input that was used in the tick before. Devices without an edge of their own are
// interpolated at the edges of others.
TickSamples unpack_samples(const MatchInput& before, const MatchInput& now, double start_s,
                           double end_s);
PlayerCommands unpack_commands(const MatchInput& input);

// Turns samples of devices, of any rate, into inputs of ticks.
class TickSampler {
  public:
    // Samples in the order of their times. Later ones than the next tick's end are kept, up to
    // k_most_waiting; beyond that the oldest are dropped. A sample without a time is ignored.
    void add(const TrackingSample& sample);
    // The input of the tick that ends at `end_s`. Poses are interpolated if a later sample is
    // known, and held otherwise, for k_longest_hold_s at most; then the devices count as not
    // tracked.
    MatchInput take(double start_s, double end_s, const PlayerCommands& commands,
                    std::uint32_t buttons = 0);

    // Forgets all samples: the devices have not been heard of.
    void forget() {
        count_ = 0;
        has_last_ = false;
        grab_ = {};
    }

    static constexpr std::size_t k_most_waiting = 64;
    static constexpr double k_longest_hold_s = 0.1;

  private:
    void take_grab(std::size_t side, std::span<const TrackingSample> used, double start_s,
                   double end_s, MatchHand& hand);
    void take_poses(double end_s, MatchInput& input) const;

    std::array<TrackingSample, k_most_waiting> waiting_;
    std::size_t count_ = 0;
    TrackingSample last_;  // the newest sample that a tick used
    bool has_last_ = false;
    std::array<bool, k_hand_count> grab_{};  // state at the end of the last tick
};

}  // namespace handhold
