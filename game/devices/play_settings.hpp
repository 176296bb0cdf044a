#pragma once

#include <cstdint>

#include "game/render/renderer.hpp"

namespace handhold {

enum class TurnKind : std::uint8_t { snap, smooth };

// The player's preferences. They are not part of the World's state and do not affect replays.
struct PlaySettings {
    double mouse_rad_per_px = 0.0025;  // [0.0002, 0.02]
    double stick_look_radps = 2.2;     // [0.2, 8]; turn rate at full deflection of the right stick
    double fov_rad = 1.25;             // [0.6, 2]; vertical
    TurnKind turn = TurnKind::snap;    // how the play space is turned; also for a headset
    // [0, 1]; maximum darkening of the edges during fast movement
    double vignette = 0.5;
    PictureQuality quality = PictureQuality::quick;
};

}  // namespace handhold
