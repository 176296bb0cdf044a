#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "game/render/body_figures.hpp"
#include "game/render/controller_figures.hpp"
#include "game/render/hand_figures.hpp"
#include "game/view/ghost_hands.hpp"

// The models that players are drawn with.
namespace handhold {

struct PlayerModels {
    HandModels hands = builtin_hand_models();
    BodyModel body = builtin_body_model();
    std::optional<ControllerModels> controllers;  // in empty hands; none: not drawn
    GhostSettings ghosts;
    std::vector<std::string> notes = {};  // about the loaded files; see GltfLevel::notes

    // Controller poses in the hand, by HandSide, if a profile defines them; else Tuning does.
    std::optional<std::array<Pose, k_hand_count>> controller_joints() const {
        return controllers && controllers->has_own_joint ? std::optional(controllers->joints())
                                                         : std::nullopt;
    }
};

// Files from a command line; an empty one selects the robot.
struct PlayerModelFiles {
    std::vector<std::string> hands;  // two skins, left and right
    std::string body;                // a figure
    std::string body_map;            // names of its joints
    std::string controllers;         // "builtin" or a profile; empty: none
};
Result<PlayerModels> choose_player_models(const PlayerModelFiles& files);

}  // namespace handhold
