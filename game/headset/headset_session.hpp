#pragma once

#include <array>
#include <optional>
#include <vector>

#include "game/devices/headset_reading.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

// A scene played with a headset by one player, frame by frame.
class HeadsetSession {
  public:
    HeadsetSession(Scene scene, const Pose& origin_ws);

    // Replaces Tuning's joint by a controller's own. Call before the first frame.
    void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip);
    // The joints set above; nullptr if none were.
    const std::array<Pose, k_hand_count>* controller_joints() const {
        return joints_ ? &*joints_ : nullptr;
    }

    // Steps one frame of dt_s. `sample` is taken at its end; in the first frame also at its start.
    void step(TrackingSample sample, PlayerCommands commands, double dt_s);

    // Vibration of the controllers after the last frame: weak if a palm came close to a surface,
    // strong if the hand gripped.
    std::array<HapticPulse, k_hand_count> pulses() const { return pulses_; }

    const Scene& scene() const { return scene_; }
    const FrameCaches& caches() const { return caches_; }
    const StageStats& stats() const { return stats_; }  // statistics of the last frame
    const PlayerEntities& player() const { return player_; }
    double t_s() const { return scene_.world.clock.t_s; }

    // Records the input from the first frame on. Replayed from the same place at the same rate, it
    // gives the same state bit for bit, except for turns, brake and thrusters.
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
