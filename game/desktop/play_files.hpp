#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "game/commands/play_command.hpp"
#include "game/desktop/play_tally.hpp"
#include "game/render/image.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

// The files of a play: what it begins with and what it leaves, at a desk or in a headset.
namespace handhold {

struct PlayedScene {
    Scene scene;
    SceneSpawnPoint place;  // the origin where the scene names none
};
Result<PlayedScene> load_played_scene(const PlayOptions& options);

// Said before anything is played: a session that cannot be kept is not begun.
std::optional<FileError> check_play_files(const PlayOptions& options);

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;
// Null where none is asked for.
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
// What the options ask to keep: the recording, the last picture, the report.
std::optional<FileError> save_play(const PlayOptions& options, const EndedPlay& play,
                                   const PlayTally& tally, const Image& image);

}  // namespace handhold
