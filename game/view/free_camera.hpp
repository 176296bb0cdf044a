#pragma once

#include <array>

#include "game/desktop/desktop_body.hpp"

namespace handhold {

// A camera that flies where keys and mouse send it, through walls too, while the player stays where
// he is and keeps hold of what he grips.
class FreeCamera {
  public:
    // From a camera on, level with `up_ws`; the player's hands stay as `input` has them.
    void begin(const Pose& camera_ws, const Vec3& up_ws, const DesktopInput& input);
    // What is asked of the player now goes to the camera, for dt_s.
    void fly(const DesktopInput& input, double dt_s);
    // What is left for the player: his grips.
    DesktopInput held() const;

    const Pose& pose_ws() const { return pose_ws_; }

  private:
    Pose pose_ws_;
    Vec3 up_ws_ = Vec3::UnitY();
    std::array<bool, k_hand_count> grip_{};
};

}  // namespace handhold
