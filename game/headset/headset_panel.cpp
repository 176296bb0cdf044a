#include "game/headset/headset_panel.hpp"

#include <cmath>

#include <handhold/math.hpp>

namespace handhold {

hh::Pose panel_before(const hh::Pose& head_ps) {
    // Looking straight up, the forehead points backwards; looking straight down, it points ahead.
    const hh::Vec3 look = head_ps.rotation * -hh::k_z;
    const hh::Vec3 forehead = head_ps.rotation * hh::k_y;
    hh::Vec3 ahead = look + (look.y > 0.0 ? -1.0 : 1.0) * std::abs(look.y) * forehead;
    ahead.y = 0.0;
    if (hh::length(ahead) < 1e-6) {
        ahead = -hh::k_z;
    }
    const hh::Vec3 way =
        HeadsetPanel::k_away_m * hh::normalized(ahead) - HeadsetPanel::k_below_m * hh::k_y;
    return {head_ps.position + way, hh::look_rotation(way, hh::k_y)};
}

void HeadsetPanel::follow(const HeadsetReading& reading) {
    if (reading.head_ps && hh::is_valid(*reading.head_ps)) {
        head_ps_ = reading.head_ps;
    }
    const bool left = reading.hands[HH_LEFT].calibrate;
    const bool right = reading.hands[HH_RIGHT].calibrate;
    const bool lets_go = is_down_ && !left;
    was_both_ = (is_down_ && was_both_) || (left && right);
    if (lets_go && !was_both_ && head_ps_) {
        shows_ = !shows_;
        pose_ps_ = panel_before(*head_ps_);
    }
    was_both_ = left && was_both_;
    is_down_ = left;
}

}  // namespace handhold
