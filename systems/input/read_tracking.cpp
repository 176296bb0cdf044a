#include "systems/input/read_tracking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "components/hand_indices.hpp"
#include "components/scaled_tuning.hpp"
#include "engine/core/check.hpp"
#include "systems/input/shared/hand_motion.hpp"
#include "systems/input/shared/motion_limit.hpp"
#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {
namespace {

constexpr double k_half_turn_rad = 3.14159265358979323846;

// True if the sample is later than the end of the frame; false for a time of NaN.
bool is_later(double t_s, double end_s) { return std::isfinite(t_s) && t_s > end_s; }

// Finds state and pose at the end of the frame, for the head and for hands alike. `later` is the
// first pose after the frame's end, or null. Returns true if no later pose is usable, so that an
// older one is held.
template <typename Device>
bool finish_device(Device& device, bool has_sample, const Pose* later, double later_t_s,
                   double end_s, double lost_after_s, StageStats& stats) {
    if (!has_sample && later == nullptr) {
        return false;  // never tracked
    }
    const bool first = device.state == TrackingState::never;
    if (has_sample && later != nullptr && later_t_s - device.sample_t_s > lost_after_s) {
        later = nullptr;  // the motion across a gap that long is unknown
    }
    if (!has_sample) {
        // The first frame has only a sample after its end. That sample's buttons count in its own
        // frame.
        device.sample_ps = *later;
        device.sample_t_s = end_s;
    }
    if (later == nullptr && end_s - device.sample_t_s > lost_after_s) {
        if (device.state != TrackingState::lost) {
            stats.count(Fallback::tracking_lost);
        }
        device.state = TrackingState::lost;
        return true;
    }
    device.state = TrackingState::tracked;
    device.pose_ps = device.sample_ps;
    if (later != nullptr && later_t_s > device.sample_t_s && end_s > device.sample_t_s) {
        const double t = (end_s - device.sample_t_s) / (later_t_s - device.sample_t_s);
        device.pose_ps = interpolate(device.sample_ps, *later, std::clamp(t, 0.0, 1.0));
    }
    if (first) {
        device.start_ps = device.pose_ps;
    }
    return later == nullptr;
}

void begin_edge(HandTracking& hand, const HandHistory& history, double t_s, const Pose& hand_ps,
                const TrackingTuning& tuning) {
    hand.pressed = !hand.pressed;
    hand.edge = hand.pressed ? GrabEdge::onset : GrabEdge::release;
    hand.edge_t_s = t_s;
    hand.edge_ps = hand_ps;
    if (hand.edge == GrabEdge::release) {
        measure_release(history, t_s, tuning.release_window_s, hand);
    }
}

// True if a hand could have come to `hand_ps`:
//  - from its last sample at tracking.max_hand_speed_mps, or from where its own velocity would have
//    taken it (fast hands are fast for several samples);
//  - and, after a reading that was ignored, from that one too: two consecutive readings must agree.
// A jump by d is thus believed once d / max_hand_speed_mps has passed.
bool is_plausible(const HandTracking& hand, const HandHistory& history, const Pose& hand_ps,
                  double t_s, double max_speed_mps, double scale) {
    const double dt_s = t_s - hand.sample_t_s;
    const bool was_ignored = hand.reading_t_s > hand.sample_t_s;
    if (could_move(hand.sample_ps, hand_ps, dt_s, max_speed_mps, scale)) {
        return !was_ignored ||
               could_move(hand.reading_ps, hand_ps, t_s - hand.reading_t_s, max_speed_mps, scale);
    }
    return !hand.interrupted &&
           could_move(extrapolated(hand, history, t_s), hand_ps, dt_s, max_speed_mps, scale);
}

// One hand and all that its readings are compared with.
struct HandReader {
    HandTracking& hand;
    HandHistory& history;
    PlaySpaceTracker space;  // state at the end of the last frame
    HandSide side;
    const ReadTrackingIo& io;
    const Tuning& tuning;  // numbers of a player of that scale
    double scale;          // PlayerOrigin::scale
    StageStats& stats;
    bool freezes_guesses = false;  // guesses do not move the hand
    bool has_sample = false;
    bool has_jumped = false;
    bool is_inferred = false;        // the last reading used was a guess
    std::optional<Pose> guess_ps{};  // the last guess of this frame

    // Why a reading is ignored; none if it is used. `is_meant`: the devices jumped as intended, so
    // any travel of the hand is plausible.
    std::optional<Fallback> refusal(const ControllerSample& reading, const Pose& hand_ps,
                                    double t_s, bool is_meant) const {
        if (!is_trackable(reading.controller_ps)) {
            return Fallback::sample_not_finite;
        }
        if (is_asleep(reading)) {
            return Fallback::device_asleep;
        }
        if (!space.is_in_reach(hand_ps.position, tuning.hand.max_arm_m)) {
            return Fallback::hand_out_of_reach;
        }
        if (has_sample && !is_meant && !reading.is_inferred &&
            !is_plausible(hand, history, hand_ps, t_s, tuning.tracking.max_hand_speed_mps, scale)) {
            return Fallback::hand_implausible;
        }
        return std::nullopt;
    }

    // True if the hand comes back at another place than where it was last shown.
    bool jumps_to(const Pose& hand_ps) const {
        const bool is_first = hand.sample_t_s < io.frame_start_s;
        return has_sample && hand.interrupted &&
               travel_m(is_first ? hand.start_ps : hand.sample_ps, hand_ps, scale) >
                   scale * k_unnoticed_m;
    }

    void ignore(Fallback reason, const Pose& hand_ps, double t_s) {
        stats.count(reason);
        hand.interrupted = has_sample;
        if (reason == Fallback::hand_implausible) {
            hand.reading_ps = hand_ps;
            hand.reading_t_s = t_s;
        }
    }

    // Uses a pose that the runtime guessed.
    void follow_guess(const Pose& hand_ps, double t_s) {
        if (!has_sample) {  // no sample of the hand was measured yet
            hand.sample_ps = hand.reading_ps = hand_ps;
            hand.sample_t_s = hand.reading_t_s = t_s;
            has_sample = true;
        }
        hand.interrupted = true;
        hand.inferred_t_s = t_s;
        is_inferred = true;
        guess_ps = hand_ps;
    }

    // `is_meant`: the devices were moved as intended. The hand did not travel, and its velocity is
    // unknown.
    void jump_with_space(bool is_meant) {
        if (is_meant) {
            hand.interrupted = has_sample;
            clear(history);
        }
    }

    void believe(const Pose& hand_ps, double t_s) {
        if (jumps_to(hand_ps)) {
            has_jumped = true;
            if (hand.reading_t_s > hand.sample_t_s) {
                clear(history);  // no velocity after a jump
            }
            if (hand.edge == GrabEdge::onset) {  // the hand closes where it is now
                hand.edge_ps = hand_ps;
                hand.edge_t_s = std::max(t_s, io.frame_start_s);
            }
        }
        hand.sample_ps = hand.reading_ps = hand_ps;
        hand.sample_t_s = hand.reading_t_s = t_s;
        hand.interrupted = false;
        has_sample = true;
        is_inferred = false;
        remember(history, hand);
    }

    void read_button(const ControllerSample& reading, double t_s, bool is_believed) {
        hand.raw_pressed = reading.grab;
        hand.squeeze = pressed_share(reading.squeeze);
        hand.trigger = pressed_share(reading.trigger);
        hand.curls = known_curls(reading.curls);
        // A hand that cannot be seen may let go, but does not close until it is seen again.
        const bool may_begin = has_sample && (is_believed || !reading.grab);
        if (may_begin && reading.grab != hand.pressed && hand.edge == GrabEdge::none) {
            begin_edge(hand, history, std::max(t_s, io.frame_start_s), hand.sample_ps,
                       tuning.tracking);
        }
    }

    void begin_frame() {
        hand.start_ps = hand.pose_ps;
        hand.edge = GrabEdge::none;
        // As in read_button: a hand that is not seen may let go.
        const bool may_begin_now = hand.pressed
                                       ? hand.state != TrackingState::never
                                       : hand.state == TrackingState::tracked && !hand.interrupted;
        if (hand.raw_pressed != hand.pressed && may_begin_now) {
            begin_edge(hand, history, io.frame_start_s, hand.start_ps, tuning.tracking);
        }
    }

    void read(const PlayerInput& input) {
        const TrackingState before = hand.state;
        has_sample = before != TrackingState::never;
        is_inferred = before == TrackingState::inferred;
        begin_frame();
        std::optional<Pose> later;
        double later_t_s = 0.0;
        for (const TrackingSample& sample : input.samples) {
            const ControllerSample& reading = sample.controllers[index_of(side)];
            const bool is_meant =
                space.follow(sample, tuning.tracking) == PlaySpaceTracker::Jump::meant;
            const Pose hand_ps = space.hand_ps(reading, side);
            const std::optional<Fallback> why_not = refusal(reading, hand_ps, sample.t_s, is_meant);
            if (is_later(sample.t_s, io.frame_end_s)) {
                if (!why_not && !is_meant && !reading.is_inferred && !jumps_to(hand_ps)) {
                    later = hand_ps;
                    later_t_s = sample.t_s;
                }
                break;
            }
            if (is_stale(sample.t_s, has_sample, last_t_s())) {
                continue;  // counted once per player, for the head
            }
            if (why_not) {
                ignore(*why_not, hand_ps, sample.t_s);
            } else if (reading.is_inferred) {
                follow_guess(hand_ps, sample.t_s);
            } else {
                jump_with_space(is_meant);
                believe(hand_ps, sample.t_s);
            }
            read_button(reading, sample.t_s, !why_not && !reading.is_inferred);
        }
        if (is_inferred && io.frame_end_s - hand.inferred_t_s <= tuning.tracking.lost_after_s) {
            finish_guess(before);
        } else {
            finish(before, later ? &*later : nullptr, later_t_s);
        }
    }

    double last_t_s() const {
        return is_inferred ? std::max(hand.sample_t_s, hand.inferred_t_s) : hand.sample_t_s;
    }

    void finish_guess(TrackingState before) {
        hand.state = TrackingState::inferred;
        hand.resumed = false;
        if (guess_ps && !freezes_guesses) {
            hand.pose_ps = *guess_ps;
        } else if (before == TrackingState::tracked && freezes_guesses) {
            hand.pose_ps = hand.sample_ps;
        }
        if (before == TrackingState::never) {
            hand.start_ps = hand.pose_ps;
        }
    }

    void finish(TrackingState before, const Pose* later, double later_t_s) {
        // A pose that is held longer than this interrupts the hand. Devices of 30 Hz and more never
        // exceed it.
        constexpr double k_longest_hold_s = 0.05;
        const bool is_held = finish_device(hand, has_sample, later, later_t_s, io.frame_end_s,
                                           tuning.tracking.lost_after_s, stats);
        hand.interrupted =
            hand.interrupted || (is_held && io.frame_end_s - hand.sample_t_s > k_longest_hold_s);
        hand.resumed = hand.state == TrackingState::tracked &&
                       (before == TrackingState::lost || before == TrackingState::inferred ||
                        (has_jumped && before != TrackingState::never));
        if (hand.resumed) {
            hand.start_ps = hand.pose_ps;
        }
    }
};

void read_head(HeadTracking& head, PlaySpaceTracker space, const PlayerInput& input,
               const ReadTrackingIo& io, const TrackingTuning& tuning, StageStats& stats) {
    bool has_sample = space.has_head();
    bool has_jumped = false;
    head.start_ps = head.pose_ps;
    Pose later;
    const Pose* later_or_null = nullptr;
    double later_t_s = 0.0;
    for (const TrackingSample& sample : input.samples) {
        const bool is_stale_now = is_stale(sample.t_s, has_sample, head.sample_t_s);
        const PlaySpaceTracker::Jump jump = space.follow(sample, tuning);
        if (is_later(sample.t_s, io.frame_end_s)) {
            if (is_trackable(sample.head_ps) && jump != PlaySpaceTracker::Jump::meant &&
                jump != PlaySpaceTracker::Jump::guess) {
                later = space.head_ps();
                later_or_null = &later;
                later_t_s = sample.t_s;
            }
            break;
        }
        if (is_stale_now) {
            stats.count(Fallback::sample_out_of_order);
        } else if (!is_trackable(sample.head_ps)) {
            stats.count(Fallback::sample_not_finite);
        } else {
            has_jumped = has_jumped || jump == PlaySpaceTracker::Jump::meant ||
                         jump == PlaySpaceTracker::Jump::guess;
            if (jump == PlaySpaceTracker::Jump::head ||
                jump == PlaySpaceTracker::Jump::play_space) {
                stats.count(jump == PlaySpaceTracker::Jump::head ? Fallback::head_recentred
                                                                 : Fallback::space_recentred);
            }
            head.shift_m = space.shift_m();
            head.shift_turn = space.shift_turn();
            head.before_ps = space.before_ps();
            head.before_t_s = space.before_t_s();
            head.sample_ps = space.head_ps();
            head.sample_t_s = sample.t_s;
            head.is_inferred = space.is_head_inferred();
            has_sample = true;
        }
    }
    finish_device(head, has_sample, later_or_null, later_t_s, io.frame_end_s, tuning.lost_after_s,
                  stats);
    if (has_jumped) {
        head.start_ps = head.pose_ps;  // no travel
    }
}

// Returns the input of a player; an empty one if this frame has none. Inputs are mostly in the
// order of the players, so the expected index is looked at first.
const PlayerInput& input_of(const ReadTrackingIo& io, Entity player, std::size_t expected) {
    static const PlayerInput k_silence{};
    if (expected < io.inputs.size() && io.inputs[expected].player == player) {
        return io.inputs[expected];
    }
    const auto found =
        std::find_if(io.inputs.begin(), io.inputs.end(),
                     [player](const PlayerInput& input) { return input.player == player; });
    return found == io.inputs.end() ? k_silence : *found;
}

// Clamps commands to their ranges. Numbers that are not finite become 0.
PlayerCommands finite_commands(PlayerCommands commands) {
    const auto bounded = [](double value, double low) {
        return std::isfinite(value) ? std::clamp(value, low, 1.0) : 0.0;
    };
    commands.smooth_turn = bounded(commands.smooth_turn, -1.0);
    commands.brake = bounded(commands.brake, 0.0);
    for (double& axis : commands.thrust_ps) {
        axis = bounded(axis, -1.0);
    }
    return commands;
}

Pose hand_in_controller(const ReadTrackingIo& io, Entity hand, HandSide side,
                        const HandTuning& tuning) {
    const ControllerToHand* const own = io.controller_to_hand.find(hand);
    return own != nullptr ? own->hand_in_controller : default_controller_to_hand(side, tuning);
}

// Indices in `io.owner` of a player's hands by side; the column's size where a hand is missing.
std::array<std::size_t, k_hand_count> hand_indices_of(const ReadTrackingIo& io, Entity player,
                                                      std::size_t player_index) {
    const std::size_t none = io.owner.size();
    std::array<std::size_t, k_hand_count> indices = {none, none};
    const std::size_t first = find_hand_index(io.owner, player, k_hand_count * player_index);
    if (first == none) {
        return indices;
    }
    for (const std::size_t index : {first, find_hand_index(io.owner, player, first + 1)}) {
        indices[index_of(io.owner.elements()[index].side)] = index;
    }
    return indices;
}

// True if one of the player's hands grips something that the player can pull on.
bool is_holding_on(const ReadTrackingIo& io, const std::array<std::size_t, k_hand_count>& indices) {
    return std::ranges::any_of(indices, [&](std::size_t index) {
        const Grab* const grab =
            index < io.owner.size() ? io.grab.find(io.owner.owners()[index]) : nullptr;
        return grab != nullptr && can_push_off(*grab);
    });
}

// Head and hands follow the same samples from the same state, so they agree on every correction.
void read_player(const ReadTrackingIo& io, std::size_t index, TuningOfPlayers& tunings,
                 StageStats& stats) {
    const Entity player = io.head.owners()[index];
    const PlayerOrigin& origin = io.origin.at(player);
    const Tuning& tuning = tunings.of(origin);
    HeadTracking& head = io.head.elements()[index];
    const PlayerInput& input = input_of(io, player, index);
    const std::array<std::size_t, k_hand_count> hand_indices = hand_indices_of(io, player, index);
    std::array<PlaySpaceTracker::Hand, k_hand_count> hands;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t hand_index = hand_indices[index_of(side)];
        if (hand_index < io.owner.size()) {
            const Entity entity = io.owner.owners()[hand_index];
            const HandTracking& hand = io.hand.at(entity);
            hands[index_of(side)] = {hand_in_controller(io, entity, side, tuning.hand),
                                     hand.reading_ps, hand.reading_t_s,
                                     hand.state != TrackingState::never};
        }
    }
    const RecenterGuess* const guess = io.recenter_guess.find(player);
    const bool holds_on = is_holding_on(io, hand_indices);
    const PlaySpaceTracker space(head, hands,
                                 {.corrects_jumps = guess == nullptr || guess->guesses,
                                  .freezes_guesses = holds_on,
                                  .scale = origin.scale});
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const std::size_t hand_index = hand_indices[index_of(side)];
        if (hand_index < io.owner.size()) {
            const Entity entity = io.owner.owners()[hand_index];
            const Grab* const grab = io.grab.find(entity);
            HandReader reader{io.hand.at(entity),
                              io.history.at(entity),
                              space,
                              side,
                              io,
                              tuning,
                              origin.scale,
                              stats};
            reader.freezes_guesses = holds_on && grab != nullptr && grab->kind != GripKind::none;
            reader.read(input);
        }
    }
    read_head(head, space, input, io, tuning.tracking, stats);
    if (PlayerCommands* const commands = io.commands.find(player)) {
        *commands = finite_commands(input.commands);
        commands->thrust_ps = head.shift_turn * commands->thrust_ps;
    }
}

}  // namespace

Pose default_controller_to_hand(HandSide side, const HandTuning& tuning) {
    const double outward = side == HandSide::right ? 1.0 : -1.0;
    Vec3 offset = tuning.controller_offset_m;
    offset.x() *= outward;
    // A fist around the handle: the back of the hand faces outward, the fingers' root points along
    // the controller.
    const Quat pitch = rotation_about(Vec3::UnitX(), tuning.controller_pitch_rad);
    const Quat roll = rotation_about(Vec3::UnitZ(), -0.5 * k_half_turn_rad * outward);
    return {offset, (pitch * roll).normalized()};
}

void read_tracking(const ReadTrackingIo& io, std::size_t first, std::size_t last,
                   const Tuning& tuning, StageStats& stats) {
    TuningOfPlayers tunings(tuning);
    for (std::size_t index = first; index < last; ++index) {
        read_player(io, index, tunings, stats);
    }
}

void read_tracking(const ReadTrackingIo& io, const Tuning& tuning, StageStats& stats) {
    HH_CHECK(io.frame_end_s > io.frame_start_s, "the frame has no length",
             io.frame_end_s - io.frame_start_s);
    read_tracking(io, 0, io.head.size(), tuning, stats);
}

}  // namespace handhold
