#pragma once

#include <array>
#include <optional>
#include <vector>

#include "game/headset/headset_reading.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"
#include "systems/frame.hpp"

namespace handhold {

// A scene that one person plays with a headset, frame by frame.
class HeadsetSession {
  public:
    HeadsetSession(Scene scene, const Pose& origin_ws);

    // A controller's own joint in place of Tuning's; before the first frame.
    void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip);
    // Those, or nullptr.
    const std::array<Pose, k_hand_count>* controller_joints() const {
        return joints_ ? &*joints_ : nullptr;
    }

    // One frame of dt_s: `sample` is at its end, and, before the first frame, at its beginning too.
    void step(TrackingSample sample, PlayerCommands commands, double dt_s);

    // What his controllers shake with after the last frame: a little where a palm came near enough
    // to touch something, more where the hand gripped it.
    std::array<HapticPulse, k_hand_count> pulses() const { return pulses_; }

    const Scene& scene() const { return scene_; }
    const FrameCaches& caches() const { return caches_; }
    const StageStats& stats() const { return stats_; }  // of the last frame
    const PlayerEntities& player() const { return player_; }
    double t_s() const { return scene_.world.clock.t_s; }

    // Keeps what the headset says from the first frame on. Played from the same place at the same
    // rate it repeats every bit, but for turns, brake and jets.
    void record() { records_ = true; }
    const Recording& recording() const { return recording_; }
    bool used_sticks() const { return used_sticks_; }

  private:
    void feel();
    bool touches(HandSide side) const;

    Scene scene_;
    FrameCaches caches_;
    PlayerEntities player_;
    std::optional<std::array<Pose, k_hand_count>> joints_;
    std::vector<TrackingSample> samples_;  // reused
    Recording recording_;
    bool records_ = false;
    bool used_sticks_ = false;
    std::array<bool, k_hand_count> touched_{};
    std::array<bool, k_hand_count> gripped_{};
    std::array<HapticPulse, k_hand_count> pulses_;
    StageStats stats_;
};

}  // namespace handhold
