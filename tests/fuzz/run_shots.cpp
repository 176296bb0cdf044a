#include <algorithm>
#include <cmath>

#include "game/commands/shot_list.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {
namespace {

bool is_file_name(const std::string& name) {
    return !name.empty() && name.find_first_of("/.\\\n") == std::string::npos;
}

}  // namespace

void run_shots(Bytes bytes) {
    const Result<std::vector<Shot>> shots = parse_shots(text_of(bytes), "fuzz.json");
    if (!shots) {
        promise(!shots.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    for (std::size_t i = 0; i < shots.value().size(); ++i) {
        const Shot& shot = shots.value()[i];
        promise(shot.number == i, "shots are in the list's order");
        promise(is_file_name(shot.name), "a name is that of a file in the folder");
        promise(shot.until_s >= shot.at_s && std::isfinite(shot.until_s), "no piece ends before");
        promise(shot.fov_deg >= 5.0 && shot.fov_deg <= 130.0, "one can look so wide");
        promise(is_finite(shot.from_m) && is_finite(shot.target_m), "the camera is somewhere");
        for (std::size_t other = 0; other < i; ++other) {
            const Shot& before = shots.value()[other];
            promise(before.name != shot.name, "no file is written twice");
            promise(before.scene != shot.scene || before.until_s <= shot.at_s ||
                        shot.until_s <= before.at_s,
                    "one is drawn at a time");
        }
    }
}

}  // namespace handhold::fuzz
