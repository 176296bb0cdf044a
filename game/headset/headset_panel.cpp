#include "game/headset/headset_panel.hpp"

namespace handhold {

Pose panel_before(const Pose& head_ps) {
    // Looking straight up, the forehead points backwards; looking straight down, it points ahead.
    const Vec3 look = head_ps.rotation * -Vec3::UnitZ();
    const Vec3 forehead = head_ps.rotation * Vec3::UnitY();
    Vec3 ahead = look + (look.y() > 0.0 ? -1.0 : 1.0) * std::abs(look.y()) * forehead;
    ahead.y() = 0.0;
    if (ahead.norm() < 1e-6) {
        ahead = -Vec3::UnitZ();
    }
    const Vec3 way =
        HeadsetPanel::k_away_m * ahead.normalized() - HeadsetPanel::k_below_m * Vec3::UnitY();
    return {head_ps.position + way, look_rotation(way, Vec3::UnitY())};
}

void HeadsetPanel::follow(const HeadsetReading& reading) {
    if (reading.head_ps && is_valid(*reading.head_ps)) {
        head_ps_ = reading.head_ps;
    }
    const bool left = reading.hands[index_of(HandSide::left)].calibrate;
    const bool right = reading.hands[index_of(HandSide::right)].calibrate;
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
