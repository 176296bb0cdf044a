#pragma once

#include <string>

namespace handhold {

// What lies over the picture while one plays.
struct Hud {
    bool can_reach = false;  // lights the mark in the middle
    bool shows_mark = true;
    bool shows_help = true;
    bool paused = false;
    double rewound_s = 0.0;  // behind the last frame that was played
    double vignette = 0.0;   // [0, 1]; how much the edges are dark
    std::string footer;      // one line, what it costs
};
void show_hud(const Hud& hud);
// One line at the foot of a film's picture.
void show_caption(const std::string& caption);

// Of the keys, the mouse and a gamepad: a line each. The help that is shown.
const char* help_text();

}  // namespace handhold
