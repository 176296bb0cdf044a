#pragma once

#include <string>
#include <vector>

namespace handhold {

// `handhold play`, as given on the command line.
struct PlayOptions {
    std::string scene = "station";
    std::string spawn;                  // empty: the scene's first
    std::string record;                 // where the session is saved; empty: nowhere
    std::string picture;                // a PNG of the last picture; empty: none
    std::vector<std::string> hand_rig;  // two skinned hands, left and right; empty: the robot's
    bool jets = false;                  // the keys push as well as pull
    double seconds = 0.0;               // 0: until the window is closed
    int width_px = 1280;
    int height_px = 720;
};

// Opens a window in which the scene is played with keyboard and mouse, in real time: where a
// picture takes longer than the session allows it to fall behind, time goes slower. Returns the
// exit status: 0; 2 after one line on standard error where a file is refused or cannot be written,
// 3 where there is nothing to draw or show with. The last line is "state_hash 0x<16 hex digits>".
int play_command(const PlayOptions& options);

}  // namespace handhold
