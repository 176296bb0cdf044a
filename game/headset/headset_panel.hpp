#pragma once

#include <optional>

#include "game/devices/headset_reading.hpp"

namespace handhold {

// The help sheet in a headset. It stays where it was first shown in the room.
class HeadsetPanel {
  public:
    static constexpr double k_away_m = 1.0;    // horizontal distance from the eyes
    static constexpr double k_below_m = 0.18;  // distance below the eyes
    static constexpr double k_width_m = 0.7;

    // Call once per reading. The left calibrate button shows the sheet before the head, or hides
    // it, when it is released without the right one having been pressed: both request calibration.
    void follow(const HeadsetReading& reading);

    bool shows() const { return shows_; }
    // Centre in the space of the readings; +Z towards the reader, +Y up. Valid while shown.
    const hh::Pose& pose_ps() const { return pose_ps_; }

  private:
    bool shows_ = false;
    bool is_down_ = false;
    bool was_both_ = false;  // both buttons, while the left one was down
    std::optional<hh::Pose> head_ps_;
    hh::Pose pose_ps_ = hh::k_origin;
};

// Pose of a panel before a head, upright and facing it, for any look direction.
hh::Pose panel_before(const hh::Pose& head_ps);

}  // namespace handhold
