#pragma once

#include <array>

#include "components/tracking.hpp"
#include "game/devices/desktop_body.hpp"

namespace handhold {

// A camera that the user flies with keys and mouse, also through walls. The player stays in place
// and keeps their grips meanwhile.
class FreeCamera {
  public:
    // Starts at `camera_ws`, levelled with `up_ws`. The player keeps the grips of `input`.
    void begin(const Pose& camera_ws, const Vec3& up_ws, const DesktopInput& input);
    // Moves the camera by `input` (instead of the player) for dt_s.
    void fly(const DesktopInput& input, double dt_s);
    // The player's input while the camera flies: only the grips.
    DesktopInput held() const;

    const Pose& pose_ws() const { return pose_ws_; }

  private:
    Pose pose_ws_;
    Vec3 up_ws_ = Vec3::UnitY();
    std::array<bool, k_hand_count> grip_{};
};

}  // namespace handhold
