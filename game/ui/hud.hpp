#pragma once

#include <string>

namespace handhold {

// Content of the overlay while somebody plays.
struct Hud {
    bool can_reach = false;  // true: highlights the mark in the centre
    bool shows_mark = true;
    bool shows_help = true;
    std::string hint;  // what somebody who plays for the first time may do next; empty: nothing
    bool paused = false;
    double rewound_s = 0.0;  // time by which the paused session is rewound
    double vignette = 0.0;   // [0, 1]; darkness of the edges
    std::string score;       // score of the game that is played; empty: none
    std::string footer;      // one line of costs
};
void show_hud(const Hud& hud);
// One line at the bottom of a film's picture.
void show_caption(const std::string& caption);

// A short help for the terminal: looking around, reaching, and pulling oneself along.
const char* help_text();

}  // namespace handhold
