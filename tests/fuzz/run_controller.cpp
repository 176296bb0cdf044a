#include "game/devices/controller_profile.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

void run_controller(Bytes bytes) {
    const Result<ControllerProfile> profile =
        parse_controller_profile(text_of(bytes), "folder/fuzz.json");
    if (!profile) {
        promise(!profile.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    for (const ControllerSide& side : profile.value().sides) {
        promise(hh::is_valid(side.fit.hand_in_grip), "a joint has finite numbers");
        promise(hh::is_valid(controller_in_hand(side.fit)), "so has its inverse");
    }
}

}  // namespace handhold::fuzz
