#include "game/assets/body_clips_asset.hpp"

#include <utility>

#include "engine/core/check.hpp"
#include "game/assets/assets.hpp"
#include "systems/rigs/body_clips_json.hpp"

namespace handhold {

BodyClips game_body_clips() {
    Result<BodyClips> clips = parse_body_clips(game_asset("body_clips.json"), "body_clips.json");
    HH_CHECK(clips.ok(), "the body's clips are good", 0);
    return std::move(clips.value());
}

}  // namespace handhold
