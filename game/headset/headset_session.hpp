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

    // Replaces the controller-to-hand joints from Tuning, by HandSide. Call before the first frame.
    void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip);
    // The joints set by set_controller_joints, or nullptr.
    const std::array<Pose, k_hand_count>* controller_joints() const {
        return joints_ ? &*joints_ : nullptr;
    }

    // Steps one frame of dt_s. `sample` applies to the end of the frame; in the first frame, also
    // to its beginning.
    void step(TrackingSample sample, PlayerCommands commands, double dt_s);

    // Haptic pulses due after the last frame, by HandSide: weak if the palm has begun to touch
    // something, strong if the hand has begun to grip.
    std::array<HapticPulse, k_hand_count> pulses() const { return pulses_; }

    const Scene& scene() const { return scene_; }
    const FrameCaches& caches() const { return caches_; }
    const StageStats& stats() const { return stats_; }  // of the last frame
    const PlayerEntities& player() const { return player_; }
    double t_s() const { return scene_.world.clock.t_s; }

    // Records the tracking samples; call before the first frame. Replayed from the same start pose
    // at the same rate, they reproduce the session bit for bit, unless the player used turns, brake
    // or jets (used_sticks).
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
