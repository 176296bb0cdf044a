#include <cmath>

#include "game/commands/grip_file.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

void run_grip(Bytes bytes) {
    const Result<SceneGrip> grip =
        parse_grip_glb(text_of(bytes), "fuzz.glb",
                       {builtin_hand_rig(HandSide::left), builtin_hand_rig(HandSide::right)});
    if (!grip) {
        promise(!grip.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    promise(!write_scene_grip(grip.value()).empty(), "an accepted grip can be written");
}

}  // namespace handhold::fuzz
