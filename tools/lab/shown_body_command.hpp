#pragma once

#include <filesystem>
#include <optional>
#include <string>

// `handhold-lab shown-body`: measures the body that is shown for a player, in a built-in session.
namespace handhold::lab {

struct ShownBodyOptions {
    std::string scene = "station";
    double hz = 90.0;
    std::optional<double> hang;  // SpineTuning::hang; nullopt: as the scene has it
    std::filesystem::path json;
    std::filesystem::path csv;  // empty: none
};

// Plays the scene's own session and measures the first player's trunk and legs in every frame.
// Exit status: 0, 1 for a scene without a session, or 2 if a file cannot be written.
int shown_body_command(const ShownBodyOptions& options);

}  // namespace handhold::lab
