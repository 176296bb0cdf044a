#pragma once

#include <string>
#include <vector>

#include "game/render/player_models.hpp"

namespace handhold {

struct PictureOptions {
    std::string scene;
    std::string out;         // folder
    std::string spawn;       // name of a spawn; empty: all
    double yaw_deg = 0.0;    // to the left of the spawn's direction
    double pitch_deg = 0.0;  // up
    double seconds = 0.0;    // simulated time before the picture
    std::string hands;       // "open", "fist": both hands before the eyes; empty: none
    std::string grips_of;    // name of a body: draw its authored grips from four sides instead
    PlayerModelFiles models;
    int width_px = 960;
    int height_px = 540;
};

// `handhold pictures`: the view from each spawn as DIR/<spawn>.png; or a body with a right hand in
// its first authored grip and a left hand in its second, as DIR/<body>_<side>.png. Names are
// encoded by file_name. Returns the exit status.
int picture_command(const PictureOptions& options);

}  // namespace handhold
