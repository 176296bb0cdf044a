#pragma once

#include <string>

#include "game/desktop/play_settings.hpp"

namespace handhold {

// Choices made in the menu in this picture.
struct MenuChoice {
    std::string scene;     // scene to play now; empty: none
    bool quality = false;  // the settings' quality has changed
    bool goes_on = false;  // closes the menu
    bool leaves = false;
};
// Shows scenes with descriptions, and the settings, which it changes.
MenuChoice show_menu(const std::string& playing, PlaySettings& settings);

}  // namespace handhold
