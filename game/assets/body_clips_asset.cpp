#include "game/assets/body_clips_asset.hpp"

#include <stdexcept>
#include <string>

#include "game/assets/assets.hpp"

namespace handhold {

void load_game_body_clips(hh::World& world) {
    if (const hh::Status loaded = world.load_body_clips(game_asset("body_clips.json")); !loaded) {
        throw std::logic_error("body_clips.json: " + std::string(loaded.text()));
    }
}

}  // namespace handhold
