#pragma once

#include <string>

#include "game/devices/play_settings.hpp"

namespace handhold {

// What the player chose in the menu in this picture.
struct MenuChoice {
    std::string scene;     // scene to play now; empty: none
    bool quality = false;  // true: the settings' quality has changed
    bool goes_on = false;  // true: the player closes the menu and plays on
    bool leaves = false;
};
// Shows the scenes with descriptions, and the settings. Changes `settings` directly.
MenuChoice show_menu(const std::string& playing, PlaySettings& settings);

}  // namespace handhold
