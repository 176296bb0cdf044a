# Scene descriptions are compiled into programs, so no file must be found at run time. Sets handhold_game_assets to the source.
file(GLOB game_assets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/game/assets/*.json)
set(game_asset_cases)
foreach(asset IN LISTS game_assets)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${asset})
  get_filename_component(asset_name ${asset} NAME)
  file(READ ${asset} asset_text)
  string(APPEND game_asset_cases "    if (name == \"${asset_name}\") {\n        return R\"json(${asset_text})json\";\n    }\n")
endforeach()
set(handhold_game_assets ${PROJECT_BINARY_DIR}/generated/assets.cpp)
file(CONFIGURE OUTPUT ${handhold_game_assets} @ONLY CONTENT [==[
#include "game/assets/assets.hpp"
namespace handhold {
std::string_view game_asset([[maybe_unused]] std::string_view name) {
@game_asset_cases@    return {};
}
}  // namespace handhold
]==])
