#pragma once

#include <string>
#include <vector>

#include "game/render/player_models.hpp"

namespace handhold {

struct PictureOptions {
    std::string scene;
    std::string out;         // folder
    std::string spawn;       // one of the scene's; empty: all
    double yaw_deg = 0.0;    // turned to the left from where the spawn faces
    double pitch_deg = 0.0;  // up
    double seconds = 0.0;    // into the scene
    std::string hands;       // "open", "fist": both hands before the eyes; empty: none
    std::string grips_of;    // a body: its authored grips from four sides instead
    PlayerModelFiles models;
    int width_px = 960;
    int height_px = 540;
};

// `handhold pictures`: what somebody at each spawn sees, as DIR/<spawn>.png; or a body with a right
// hand in its first authored grip and a left one in its second, as DIR/<body>_<side>.png. Returns
// the exit status.
int picture_command(const PictureOptions& options);

}  // namespace handhold
