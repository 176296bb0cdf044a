#pragma once

#include <string>

namespace handhold {

// Content of the overlay while somebody plays.
struct Hud {
    bool can_reach = false;  // highlights the mark in the centre
    bool shows_mark = true;
    bool shows_help = true;
    bool paused = false;
    double rewound_s = 0.0;  // how far the session is rewound
    double vignette = 0.0;   // [0, 1]; darkness of the edges
    std::string footer;      // one line of costs
};
void show_hud(const Hud& hud);
// One line at the bottom of a film's picture.
void show_caption(const std::string& caption);

// The help text: one line each for keys, mouse and gamepad.
const char* help_text();

}  // namespace handhold
