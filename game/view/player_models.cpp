#include "game/view/player_models.hpp"

namespace handhold {
namespace {

void append(const std::vector<std::string>& from, std::vector<std::string>& to) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Result<PlayerModels> choose_player_models(const PlayerModelFiles& files) {
    Result<HandModels> hands = choose_hand_models(files.hands);
    if (!hands) {
        return hands.error();
    }
    Result<BodyModel> body = choose_body_model(files.body, files.body_map);
    if (!body) {
        return body.error();
    }
    PlayerModels models{std::move(hands.value()), std::move(body.value()), std::nullopt, {}};
    for (const HandModel& hand : models.hands) {
        if (hand.skin) {
            append(hand.skin->notes, models.notes);
        }
    }
    append(models.body.figure.notes, models.notes);
    if (!files.controllers.empty()) {
        Result<ControllerModels> controllers = choose_controllers(files.controllers);
        if (!controllers) {
            return controllers.error();
        }
        models.controllers = std::move(controllers.value());
        append(models.controllers->notes, models.notes);
    }
    return models;
}

}  // namespace handhold
