#pragma once

#include <string>

#include "game/desktop/play_settings.hpp"

namespace handhold {

// What was chosen in the menu, in this picture.
struct MenuChoice {
    std::string scene;     // to be played now; empty: none
    bool quality = false;  // the settings' quality has changed
    bool goes_on = false;  // closes the menu
    bool leaves = false;
};
// Scenes with what they show, and settings, which it changes.
MenuChoice show_menu(const std::string& playing, PlaySettings& settings);

}  // namespace handhold
