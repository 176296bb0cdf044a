#pragma once

#include <string>
#include <vector>

#include "game/view/player_models.hpp"

namespace handhold {

struct PictureOptions {
    std::string scene;
    std::string out;         // folder for the pictures
    std::string spawn;       // name of a spawn; empty: all
    double yaw_deg = 0.0;    // angle of the view direction to the left of the spawn's
    double pitch_deg = 0.0;  // angle of the view direction upwards
    double seconds = 0.0;    // simulated time before the picture
    std::string hands;       // "open", "fist": both hands in front of the eyes; empty: none
    std::string grips_of;    // name of a body: draw its authored grips from four sides instead
    PlayerModelFiles models;
    int width_px = 960;
    int height_px = 540;
};

// `handhold pictures`: saves the view from each spawn as DIR/<spawn>.png. With `grips_of`: saves
// that body with a right hand in its first authored grip and a left hand in its second, as
// DIR/<body>_<side>.png. Names are encoded with file_name(). Returns the exit status.
int picture_command(const PictureOptions& options);

}  // namespace handhold
