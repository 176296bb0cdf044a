#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"

namespace handhold {

inline constexpr double k_farthest_tracked_m = 1e4;
inline constexpr double k_latest_s = 1e9;  // a snapshot refuses later times too

// False for a pose that no tracking system can mean: not valid, or k_farthest_tracked_m or more
// away along an axis.
bool is_trackable(const Pose& pose_ps);
// A controller that sleeps, or was never found, reports exactly (0, 0, 0).
inline bool is_asleep(const ControllerSample& reading) {
    return reading.controller_ps.position == Vec3::Zero();
}
inline bool is_seen(const ControllerSample& reading) {
    return is_trackable(reading.controller_ps) && !is_asleep(reading);
}
// How far a button is pressed, [0, 1]; 0 if `reading` is NaN.
inline double pressed_share(double reading) { return reading > 0.0 ? std::min(1.0, reading) : 0.0; }
// True for a sample that is not newer than the last one, or has no time or one beyond k_latest_s.
bool is_stale(double t_s, bool has_sample, double last_t_s);

// Follows one player's readings from sample to sample and corrects those that jump with the play
// space. Started from the state at the end of the last frame, it gives the same corrections to
// whoever follows the same samples.
class PlaySpaceTracker {
  public:
    struct Hand {
        Pose in_controller;
        Pose reading_ps;  // last valid one, corrected
        double reading_t_s = 0.0;
        bool has_reading = false;
    };
    enum class Jump : std::uint8_t { none, head, play_space };

    PlaySpaceTracker(const HeadTracking& head, const std::array<Hand, k_hand_count>& hands);

    // Advances to `sample`. From a jump on, all readings are corrected so that the head goes on as
    // before (play_space) or stays where it was (head):
    //  - play_space: head and hands moved by one transform (a turn about +Y and a translation), at
    //    least one of them farther than a device can move. What remains of each hand's motion once
    //    that transform is undone must be one that a hand can make;
    //  - head: the head moved farther than TrackingTuning::max_jump_m, and the hands did not match.
    Jump follow(const TrackingSample& sample, const TrackingTuning& tuning);

    // Of the sample followed last.
    Pose hand_ps(const ControllerSample& reading, HandSide side) const;
    bool is_in_reach(const Vec3& hand_ps, double max_arm_m) const;

    const Pose& head_ps() const { return head_ps_; }      // last valid one, corrected
    const Pose& before_ps() const { return before_ps_; }  // the valid one before that
    double before_t_s() const { return before_t_s_; }
    bool has_head() const { return has_head_; }
    const Vec3& shift_m() const { return shift_.position; }
    const Quat& shift_turn() const { return shift_.rotation; }

  private:
    Pose corrected(const Pose& pose) const;
    std::array<std::optional<double>, k_hand_count> hand_ages_s(const TrackingSample& sample,
                                                                double lost_after_s) const;
    bool find_recentring(const TrackingSample& sample, const Pose& head_ps,
                         const TrackingTuning& tuning, Pose& undo) const;
    void shift_by(const Pose& undo);
    void keep_hands(const TrackingSample& sample);

    Pose shift_;
    Pose head_ps_;
    double head_t_s_ = 0.0;
    Pose before_ps_;
    double before_t_s_ = 0.0;
    bool has_head_ = false;
    std::array<Hand, k_hand_count> hands_;
};

}  // namespace handhold
