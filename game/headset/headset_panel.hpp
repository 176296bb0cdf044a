#pragma once

#include <optional>

#include "game/headset/headset_reading.hpp"

namespace handhold {

// The help panel in a headset. It stays where it was opened in the room.
class HeadsetPanel {
  public:
    static constexpr double k_away_m = 1.0;    // horizontal distance from the eyes
    static constexpr double k_below_m = 0.18;  // distance below the eyes
    static constexpr double k_width_m = 0.7;

    // Call once per reading. Pressing and releasing the left calibrate button opens the panel in
    // front of the head, or closes it. Nothing happens if the right one was pressed meanwhile: both
    // together start a calibration.
    void follow(const HeadsetReading& reading);

    bool shows() const { return shows_; }
    // Pose of the panel's centre in play space: +Z towards the reader, +Y up. Valid while shows().
    const Pose& pose_ps() const { return pose_ps_; }

  private:
    bool shows_ = false;
    bool is_down_ = false;
    bool was_both_ = false;  // the right button was pressed while the left one was
    std::optional<Pose> head_ps_;
    Pose pose_ps_;
};

// Pose of a panel in front of a head and turned towards the eyes, wherever the player looks.
Pose panel_before(const Pose& head_ps);

}  // namespace handhold
