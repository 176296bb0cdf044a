#pragma once

#include <array>
#include <optional>
#include <vector>

#include "game/devices/headset_reading.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// A scene played with a headset by one player, frame by frame.
class HeadsetSession {
  public:
    HeadsetSession(Scene scene, const hh::Pose& origin_ws);

    // Replaces Tuning's joint by a controller's own. Call before the first frame.
    void set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip);
    // The joints set above; nullptr if none were.
    const std::array<hh::Pose, 2>* controller_joints() const {
        return joints_ ? &*joints_ : nullptr;
    }

    // Steps one frame of dt_s. `sample` is taken at its end; in the first frame also at its start.
    void step(hh::Sample sample, hh_commands commands, double dt_s);

    // Vibration of the controllers after the last frame: weak if a palm came close to a surface,
    // strong if the hand gripped.
    std::array<HapticPulse, 2> pulses() const { return pulses_; }

    const Scene& scene() const { return scene_; }
    const hh::World& world() const { return scene_.host; }
    hh::Player player() const { return player_; }
    double t_s() const { return scene_.host.time_s(); }

    // Records the input from the first frame on. Replayed from the same place at the same rate, it
    // gives the same state bit for bit, except for turns, brake and thrusters.
    void record() { records_ = true; }
    const Recording& recording() const { return recording_; }
    bool used_sticks() const { return used_sticks_; }

  private:
    void feel();
    bool touches(hh::Side side);

    Scene scene_;
    hh::Player player_;
    std::optional<std::array<hh::Pose, 2>> joints_;
    std::vector<hh::Sample> samples_;  // reused
    Recording recording_;
    bool records_ = false;
    bool used_sticks_ = false;
    std::array<bool, 2> touched_{};
    std::array<bool, 2> gripped_{};
    std::array<HapticPulse, 2> pulses_;
};

}  // namespace handhold
