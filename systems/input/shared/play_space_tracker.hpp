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

// False for a pose that cannot come from tracking: invalid, or k_farthest_tracked_m or more from
// the origin along an axis.
bool is_trackable(const Pose& pose_ps);
// True if the controller sleeps or was never found: it then reports exactly (0, 0, 0).
inline bool is_asleep(const ControllerSample& reading) {
    return reading.controller_ps.position == Vec3::Zero();
}
inline bool is_seen(const ControllerSample& reading) {
    return is_trackable(reading.controller_ps) && !is_asleep(reading);
}
// True if the reading says where the hand is: seen, and not guessed.
inline bool is_measured(const ControllerSample& reading) {
    return is_seen(reading) && !reading.is_inferred;
}
// Limits the curls to 1. A curl that is negative or NaN becomes k_unknown_curl.
inline FingerCurls known_curls(FingerCurls curls) {
    for (double& curl : curls) {
        curl = curl >= 0.0 ? std::min(1.0, curl) : k_unknown_curl;
    }
    return curls;
}
// How far a button is pressed, [0, 1]; 0 if `reading` is NaN.
inline double pressed_share(double reading) { return reading > 0.0 ? std::min(1.0, reading) : 0.0; }
// True for a sample that is not newer than the last one, or whose time is NaN or beyond k_latest_s.
bool is_stale(double t_s, bool has_sample, double last_t_s);

// Follows one player's readings from sample to sample and corrects those that jump with the play
// space. Deterministic: the same start state and the same samples give the same corrections.
class PlaySpaceTracker {
  public:
    struct Hand {
        Pose in_controller;
        Pose reading_ps;  // last measured pose, corrected
        double reading_t_s = 0.0;
        bool has_reading = false;
    };
    enum class Jump : std::uint8_t { none, head, play_space, meant, guess };
    struct Settings {
        bool corrects_jumps = true;    // RecenterGuess::guesses of the player
        bool freezes_guesses = false;  // true: guesses of the runtime do not move the head
        double scale = 1.0;            // PlayerOrigin::scale
    };

    PlaySpaceTracker(const HeadTracking& head, const std::array<Hand, k_hand_count>& hands,
                     const Settings& settings);
    PlaySpaceTracker(const HeadTracking& head, const std::array<Hand, k_hand_count>& hands)
        : PlaySpaceTracker(head, hands, Settings{}) {}

    // Advances to `sample`. After a jump, all later readings are corrected so that the head
    // continues its motion (play_space) or stays where it was (head):
    //  - play_space: head and hands moved by one transform (a turn about +Y and a translation), at
    //    least one of them farther than a device can move. Once that transform is undone, the rest
    //    of each hand's motion must be possible for a hand;
    //  - head: the head moved farther than TrackingTuning::max_jump_m, and the hands did not match;
    //  - meant: one of these in a tracker that does not correct jumps.
    // `guess`: the head's position is inferred, or is the first measured position after inferred
    // ones. It may be anywhere, and nothing was recentred. Inferred hands are not used to find
    // recentrings.
    Jump follow(const TrackingSample& sample, const TrackingTuning& tuning);

    // The hand's pose in play space for `reading`, which belongs to the last sample followed.
    Pose hand_ps(const ControllerSample& reading, HandSide side) const;
    bool is_in_reach(const Vec3& hand_ps, double max_arm_m) const;

    const Pose& head_ps() const { return head_ps_; }  // last valid pose, corrected
    // The valid pose before head_ps(), or head_ps() itself if the head's velocity is unknown.
    const Pose& before_ps() const { return before_ps_; }
    double before_t_s() const { return before_t_s_; }
    bool has_head() const { return has_head_; }
    bool is_head_inferred() const { return is_head_inferred_; }
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
    bool is_head_inferred_ = false;
    Settings settings_;
    std::array<Hand, k_hand_count> hands_;
};

// A sample that a player's tracker has followed.
struct FollowedSample {
    const TrackingSample* sample = nullptr;
    PlaySpaceTracker space;  // state after the sample
    PlaySpaceTracker::Jump jump = PlaySpaceTracker::Jump::none;
};

}  // namespace handhold
