#include "systems/input/shared/play_space_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "systems/input/shared/motion_limit.hpp"

namespace handhold {
namespace {

// The part of a rotation that turns about +Y.
Quat turn_about_up(const Quat& rotation) {
    const Quat turn(rotation.w(), 0.0, rotation.y(), 0.0);
    constexpr double k_min_norm = 1e-6;  // upside down: any turn would do
    return turn.norm() > k_min_norm ? turn.normalized() : Quat::Identity();
}

}  // namespace

bool is_trackable(const Pose& pose_ps) {
    return is_valid(pose_ps) && pose_ps.position.cwiseAbs().maxCoeff() < k_farthest_tracked_m;
}

bool is_stale(double t_s, bool has_sample, double last_t_s) {
    return !(std::abs(t_s) <= k_latest_s) || (has_sample && t_s <= last_t_s);
}

PlaySpaceTracker::PlaySpaceTracker(const HeadTracking& head,
                                   const std::array<Hand, k_hand_count>& hands,
                                   const Settings& settings)
    : shift_{head.shift_m, head.shift_turn},
      head_ps_(head.sample_ps),
      head_t_s_(head.sample_t_s),
      before_ps_(head.before_ps),
      before_t_s_(head.before_t_s),
      has_head_(head.state != TrackingState::never),
      is_head_inferred_(head.is_inferred),
      settings_(settings),
      hands_(hands) {}

// Returns the pose unchanged, bit for bit, if there is no shift.
Pose PlaySpaceTracker::corrected(const Pose& pose) const {
    return {shift_.rotation * pose.position + shift_.position, shift_.rotation * pose.rotation};
}

Pose PlaySpaceTracker::hand_ps(const ControllerSample& reading, HandSide side) const {
    return corrected(reading.controller_ps * hands_[index_of(side)].in_controller);
}

bool PlaySpaceTracker::is_in_reach(const Vec3& hand_ps, double max_arm_m) const {
    return !has_head_ || (hand_ps - head_ps_.position).norm() <= max_arm_m;
}

PlaySpaceTracker::Jump PlaySpaceTracker::follow(const TrackingSample& sample,
                                                const TrackingTuning& tuning) {
    if (is_stale(sample.t_s, has_head_, head_t_s_)) {
        return Jump::none;
    }
    if (!is_trackable(sample.head_ps)) {
        keep_hands(sample);
        return Jump::none;
    }
    Jump jump = Jump::none;
    Pose next_ps = corrected({sample.head_ps.position, sample.head_ps.rotation.normalized()});
    Pose undo;
    if (has_head_ && (sample.is_head_inferred || is_head_inferred_)) {
        jump = Jump::guess;
        if (sample.is_head_inferred && settings_.freezes_guesses) {
            next_ps.position = head_ps_.position;
        }
    } else if (has_head_ && find_recentring(sample, next_ps, tuning, undo)) {
        jump = settings_.corrects_jumps ? Jump::play_space : Jump::meant;
        if (settings_.corrects_jumps) {
            shift_by(undo);
            next_ps = undo * next_ps;
        }
    } else if (has_head_ && (next_ps.position - head_ps_.position).norm() > tuning.max_jump_m) {
        jump = settings_.corrects_jumps ? Jump::head : Jump::meant;
        if (settings_.corrects_jumps) {
            shift_by({head_ps_.position - next_ps.position, Quat::Identity()});
            next_ps.position = head_ps_.position;
        }
    }
    const bool has_velocity = has_head_ && jump != Jump::meant && jump != Jump::guess;
    before_ps_ = has_velocity ? head_ps_ : next_ps;
    before_t_s_ = has_velocity ? head_t_s_ : sample.t_s;
    head_ps_ = next_ps;
    head_t_s_ = sample.t_s;
    has_head_ = true;
    is_head_inferred_ = sample.is_head_inferred;
    keep_hands(sample);
    return jump;
}

void PlaySpaceTracker::shift_by(const Pose& undo) {
    shift_.position = undo.rotation * shift_.position + undo.position;
    shift_.rotation = (undo.rotation * shift_.rotation).normalized();
}

void PlaySpaceTracker::keep_hands(const TrackingSample& sample) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const ControllerSample& reading = sample.controllers[index_of(side)];
        Hand& hand = hands_[index_of(side)];
        if (is_measured(reading)) {
            hand.reading_ps = hand_ps(reading, side);
            hand.reading_t_s = sample.t_s;
            hand.has_reading = true;
        }
    }
}

// For each hand that is measured in the sample, the age of its last reading. Nullopt if it has
// none, if that is older than lost_after_s, or if the hand is not measured.
std::array<std::optional<double>, k_hand_count> PlaySpaceTracker::hand_ages_s(
    const TrackingSample& sample, double lost_after_s) const {
    std::array<std::optional<double>, k_hand_count> ages_s;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const Hand& hand = hands_[index_of(side)];
        const double age_s = sample.t_s - hand.reading_t_s;
        if (hand.has_reading && is_measured(sample.controllers[index_of(side)]) &&
            age_s <= lost_after_s) {
            ages_s[index_of(side)] = age_s;
        }
    }
    return ages_s;
}

// `head_ps`: the sample's head with the corrections so far. `undo`: the transform that takes it to
// where the head would be at its last velocity. It turns only about +Y, because play spaces are
// level, so the head keeps its own tilt. Returns false if there is no recentring.
bool PlaySpaceTracker::find_recentring(const TrackingSample& sample, const Pose& head_ps,
                                       const TrackingTuning& tuning, Pose& undo) const {
    const double head_dt_s = sample.t_s - head_t_s_;
    const auto ages_s = hand_ages_s(sample, tuning.lost_after_s);
    if (head_dt_s > tuning.lost_after_s || (!ages_s[0] && !ages_s[1])) {
        return false;
    }
    const double max_mps = tuning.max_hand_speed_mps;
    // True if each hand could have moved to where its reading is once `correction` is applied.
    const auto hands_could_move = [&](const Pose& correction) {
        return std::ranges::all_of(std::array{HandSide::left, HandSide::right}, [&](HandSide side) {
            const std::size_t i = index_of(side);
            return !ages_s[i] || could_move(hands_[i].reading_ps,
                                            correction * hand_ps(sample.controllers[i], side),
                                            *ages_s[i], max_mps, settings_.scale);
        });
    };
    if (could_move(head_ps_, head_ps, head_dt_s, max_mps, settings_.scale) &&
        hands_could_move({})) {
        return false;  // nothing jumped
    }
    const Pose expected_ps = extrapolate(before_ps_, before_t_s_, head_ps_, head_t_s_, sample.t_s);
    undo.rotation = turn_about_up(expected_ps.rotation * head_ps.rotation.conjugate());
    undo.position = expected_ps.position - undo.rotation * head_ps.position;
    return could_move(head_ps_, undo * head_ps, head_dt_s, max_mps, settings_.scale) &&
           hands_could_move(undo);
}

}  // namespace handhold
