#pragma once

#include <memory>
#include <string>
#include <vector>

#include "game/commands/run_command.hpp"
#include "game/commands/shot_film.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// A session that is ready for its first frame.
struct ReadySession {
    Scene& scene;
    const std::vector<PlayerEntities>& players;
    const Recording* recording = nullptr;  // the first player's; null: none
    RunSettings settings;
};

// `run --shots`: plays the session until its last shot and saves the shots. Returns the exit
// status: 0, or 2 after one line on standard error if the list is invalid, has no shot of this
// scene, or something cannot be drawn or written.
int draw_shots(const RunOptions& options, ReadySession session, PlayerModels models);

// The film of the shots of `scene_name` in RunOptions::shots. Error: the list is invalid, has no
// shot of this scene, or nothing can be drawn.
Result<std::unique_ptr<ShotFilm>> open_shots(const RunOptions& options,
                                             const std::string& scene_name, const Scene& scene,
                                             PlayerModels models);
// Ends the film and prints the number of shots. Returns the exit status, as draw_shots.
int finish_shots(const std::string& scene, ShotFilm& film);

}  // namespace handhold
