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

    // Call once per reading. Releasing the left calibrate button shows the sheet in front of the
    // head, or hides it. A press during which the right calibrate button was held too does not
    // count, because both buttons together request calibration.
    void follow(const HeadsetReading& reading);

    bool shows() const { return shows_; }
    // Centre in the space of the readings; +Z towards the reader, +Y up. Valid while shown.
    const hh::Pose& pose_ps() const { return pose_ps_; }

  private:
    bool shows_ = false;
    bool is_down_ = false;
    bool was_both_ = false;  // the right button was held too during this press of the left one
    std::optional<hh::Pose> head_ps_;
    hh::Pose pose_ps_ = hh::k_origin;
};

// Pose of an upright panel in front of a head, facing the eyes. Valid for every look direction.
hh::Pose panel_before(const hh::Pose& head_ps);

}  // namespace handhold
