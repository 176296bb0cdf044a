#pragma once

#include <optional>

#include "game/headset/headset_reading.hpp"

namespace handhold {

// The help before whoever wears a headset: a sheet that stays in the room where it was shown.
class HeadsetPanel {
  public:
    static constexpr double k_away_m = 1.0;    // from the eyes, level
    static constexpr double k_below_m = 0.18;  // their height
    static constexpr double k_width_m = 0.7;

    // Every reading once. The left calibrate button, pressed and let go without the right one (both
    // ask to be measured), shows the sheet before the head, or puts it away.
    void follow(const HeadsetReading& reading);

    bool shows() const { return shows_; }
    // Its middle in the space of the readings; +Z to whoever reads it, +Y up. While it shows.
    const Pose& pose_ps() const { return pose_ps_; }

  private:
    bool shows_ = false;
    bool is_down_ = false;
    bool was_both_ = false;  // while it was down
    std::optional<Pose> head_ps_;
    Pose pose_ps_;
};

// Before a head, upright and turned to it wherever it looks.
Pose panel_before(const Pose& head_ps);

}  // namespace handhold
