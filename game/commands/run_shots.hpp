#pragma once

#include <vector>

#include "game/commands/run_command.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// A session that can be played.
struct ReadySession {
    Scene& scene;
    const std::vector<PlayerEntities>& players;
    const Recording* recording = nullptr;  // null: nobody plays
    RunSettings settings;
};

// `run --shots`: plays the session until its last shot and saves the shots. Returns the exit
// status: 0, or 2 after one line on standard error if the list is invalid, has no shot of this
// scene, or something cannot be drawn or written.
int draw_shots(const RunOptions& options, ReadySession session, PlayerModels models);

}  // namespace handhold
