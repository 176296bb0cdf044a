#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "game/desktop/play_options.hpp"
#include "game/mesh/image.hpp"
#include "game/play/play_tally.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

// Input and output files of a session that is played on the desktop or in a headset.
namespace handhold {

struct PlayedScene {
    Scene scene;
    // Where the player starts; the world's origin if the scene has no spawns.
    SceneSpawnPoint place;
};
Result<PlayedScene> load_played_scene(const PlayOptions& options);

// Checks the output files before play, so that nobody plays a session that cannot be saved.
std::optional<FileError> check_play_files(const PlayOptions& options);

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;
// Opens the status file; null if the options request none.
Result<OpenFile> open_status(const PlayOptions& options);

// The command line that plays the recording of `options` again bit for bit, quoted for a shell.
std::string replay_command(const PlayOptions& options, const std::string& spawn, double hz);

struct EndedPlay {
    const Scene& scene;
    const std::string& spawn;
    const Recording& recording;
    bool used_sticks = false;
    double hz = 90.0;
};
// Writes the outputs that the options request: recording, last picture, report.
std::optional<FileError> save_play(const PlayOptions& options, const EndedPlay& play,
                                   const PlayTally& tally, const Image& image);

}  // namespace handhold
