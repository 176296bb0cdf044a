#include "game/render/player_models.hpp"

namespace handhold {

Result<PlayerModels> choose_player_models(const PlayerModelFiles& files) {
    Result<HandModels> hands = choose_hand_models(files.hands);
    if (!hands) {
        return hands.error();
    }
    Result<BodyModel> body = choose_body_model(files.body, files.body_map);
    if (!body) {
        return body.error();
    }
    return PlayerModels{std::move(hands.value()), std::move(body.value())};
}

}  // namespace handhold
