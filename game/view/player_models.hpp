#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "game/render/body_figures.hpp"
#include "game/render/ghost_hands.hpp"
#include "game/render/hand_figures.hpp"
#include "game/view/controller_figures.hpp"

// The models that players are drawn with.
namespace handhold {

struct PlayerModels {
    HandModels hands = builtin_hand_models();
    BodyModel body = builtin_body_model();
    std::optional<ControllerModels> controllers;  // drawn in empty hands; nullopt: not drawn
    GhostSettings ghosts;
    std::vector<std::string> notes = {};  // remarks about the loaded files; see GltfLevel::notes

    // The hands' poses in the controllers' grip frames, indexed by hh::Side; nullopt: the profile
    // does not define them, and the tuning's poses apply.
    std::optional<std::array<hh::Pose, 2>> controller_joints() const {
        return controllers && controllers->has_own_joint ? std::optional(controllers->joints())
                                                         : std::nullopt;
    }
};

// Model files named on the command line. No hands, or an empty body: the built-in robot's.
struct PlayerModelFiles {
    std::vector<std::string> hands;  // skins, left and right; or none
    std::string body;                // file of a figure
    std::string body_map;            // file with the names of the figure's joints
    std::string controllers;         // "builtin" or a profile; empty: none
};
Result<PlayerModels> choose_player_models(const PlayerModelFiles& files);

}  // namespace handhold
