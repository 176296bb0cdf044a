#pragma once

#include <filesystem>
#include <optional>
#include <string>

// `handhold-lab shown-body`: measures the body that is shown for a player, in a session.
namespace handhold::lab {

struct ShownBodyOptions {
    std::string scene = "station";
    std::filesystem::path input;  // a recorded session; empty: the scene's own
    double hz = 90.0;
    std::optional<double> hang;  // SpineTuning::hang; nullopt: as the scene has it
    std::filesystem::path json;
    std::filesystem::path csv;  // empty: none
};

// Plays a session and measures the first player's shown body in every frame. A recorded session
// begins at the place that find_spawn chooses, with distance grabs, as `handhold run --spawn auto
// --distance-grab` plays it. Exit status: 0; 2 if a scene has no session, or a
// file cannot be read or written.
int shown_body_command(const ShownBodyOptions& options);

}  // namespace handhold::lab
