#pragma once

#include <array>
#include <string>

#include "game/desktop/play_settings.hpp"

namespace handhold {

// What the sheet in a headset says.
struct HeadsetHelp {
    TurnKind turn = TurnKind::snap;
    bool has_jets = false;
    bool pulls = false;  // the distance grab is on
    std::string notice;  // one line of how it stands; may be empty
};
// Of the whole sheet, for Overlay::resize; letters are those of a picture that is 900 high.
inline constexpr std::array<int, 2> k_headset_help_px = {680, 280};
inline constexpr int k_headset_letters_for_px = 900;
void show_headset_help(const HeadsetHelp& help);

}  // namespace handhold
