#pragma once

#include <array>
#include <string>

#include "game/devices/play_settings.hpp"

namespace handhold {

// Content of the help sheet in a headset.
struct HeadsetHelp {
    TurnKind turn = TurnKind::snap;
    bool has_jets = false;
    bool pulls = false;  // distance grab is on
    std::string notice;  // one status line; may be empty
};
// Size of the sheet, for Overlay::resize. The overlay is created for the second height, which
// determines the size of its letters.
inline constexpr std::array<int, 2> k_headset_help_px = {680, 280};
inline constexpr int k_headset_letters_for_px = 900;
void show_headset_help(const HeadsetHelp& help);

}  // namespace handhold
