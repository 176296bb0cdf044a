#include "systems/input/shared/hand_reader.hpp"

#include <algorithm>
#include <optional>

#include "systems/input/shared/device_frame.hpp"
#include "systems/input/shared/hand_motion.hpp"
#include "systems/input/shared/motion_limit.hpp"

namespace handhold {
namespace {

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
    const HandReaderIo& io;
    const Tuning& tuning;
    StageStats& stats;
    HandTracking& hand;
    HandHistory& history;
    bool has_sample = false;
    bool has_jumped = false;
    bool is_inferred = false;        // the last reading used was a guess
    std::optional<Pose> guess_ps{};  // the last guess of this frame

    // Why a reading is ignored; none if it is used. `is_meant`: the devices jumped as intended, so
    // any travel of the hand is plausible.
    std::optional<Fallback> refusal(const ControllerSample& reading, const Pose& hand_ps,
                                    const FollowedSample& followed) const {
        const double t_s = followed.sample->t_s;
        const bool is_meant = followed.jump == PlaySpaceTracker::Jump::meant;
        if (!is_trackable(reading.controller_ps)) {
            return Fallback::sample_not_finite;
        }
        if (is_asleep(reading)) {
            return Fallback::device_asleep;
        }
        if (!followed.space.is_in_reach(hand_ps.position, tuning.hand.max_arm_m)) {
            return Fallback::hand_out_of_reach;
        }
        if (has_sample && !is_meant && !reading.is_inferred &&
            !is_plausible(hand, history, hand_ps, t_s, tuning.tracking.max_hand_speed_mps,
                          io.scale)) {
            return Fallback::hand_implausible;
        }
        return std::nullopt;
    }

    // True if the hand comes back at another place than where it was last shown.
    bool jumps_to(const Pose& hand_ps) const {
        const bool is_first = hand.sample_t_s < io.frame_start_s;
        return has_sample && hand.interrupted &&
               travel_m(is_first ? hand.start_ps : hand.sample_ps, hand_ps, io.scale) >
                   io.scale * k_unnoticed_m;
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

    void read(std::span<const FollowedSample> samples) {
        const TrackingState before = hand.state;
        has_sample = before != TrackingState::never;
        is_inferred = before == TrackingState::inferred;
        begin_frame();
        std::optional<Pose> later;
        double later_t_s = 0.0;
        for (const FollowedSample& followed : samples) {
            const TrackingSample& sample = *followed.sample;
            const ControllerSample& reading = sample.controllers[index_of(io.side)];
            const bool is_meant = followed.jump == PlaySpaceTracker::Jump::meant;
            const Pose hand_ps = followed.space.hand_ps(reading, io.side);
            const std::optional<Fallback> why_not = refusal(reading, hand_ps, followed);
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
        if (guess_ps && !io.freezes_guesses) {
            hand.pose_ps = *guess_ps;
        } else if (before == TrackingState::tracked && io.freezes_guesses) {
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

}  // namespace

void read_hand(const HandReaderIo& io, std::span<const FollowedSample> samples,
               const Tuning& tuning, StageStats& stats) {
    HandReader{io, tuning, stats, io.hand, io.history}.read(samples);
}

}  // namespace handhold
