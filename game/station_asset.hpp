#pragma once

#include <string_view>

namespace handhold {

// The text of game/assets/station.json. Its source is written when the build is configured.
std::string_view station_asset();

}  // namespace handhold
