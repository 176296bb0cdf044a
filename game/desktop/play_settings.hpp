#pragma once

#include <cstdint>

#include "game/render/renderer.hpp"

namespace handhold {

enum class TurnKind : std::uint8_t { snap, smooth };

// What a player sets to his liking: none of it is state, and none changes what a recording plays.
struct PlaySettings {
    double mouse_rad_per_px = 0.0025;  // [0.0002, 0.02]
    double stick_look_radps = 2.2;     // [0.2, 8]; the right stick fully pressed
    double fov_rad = 1.25;             // [0.6, 2]; vertical
    TurnKind turn = TurnKind::snap;    // of the play space, as a headset's player turns
    double vignette = 0.5;             // [0, 1]; how much the edges darken while he is carried fast
    PictureQuality quality = PictureQuality::quick;
};

}  // namespace handhold
