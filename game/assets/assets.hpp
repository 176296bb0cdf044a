#pragma once

#include <string_view>

namespace handhold {

// The text of game/assets/<name>, compiled into the program; empty for an unknown name.
std::string_view game_asset(std::string_view name);

}  // namespace handhold
