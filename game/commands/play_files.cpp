#include "game/commands/play_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "game/files/file_tools.hpp"
#include "game/play/loading.hpp"
#include "game/play/shell_word.hpp"
#include "game/report/run_summary.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

std::optional<FileError> check_folder(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return FileError{file.string(), "", "expected an existing folder"};
    }
    return std::nullopt;
}

}  // namespace

std::string replay_command(const PlayOptions& options, const std::string& spawn, double hz) {
    constexpr double k_default_hz = 90.0;
    const auto option = [](const char* name, const std::string& value) {
        // "=" joins name and value: otherwise a value that begins with a dash would be read as an
        // option.
        return std::string(" ") + name + (value.starts_with('-') ? "=" : " ") + shell_word(value);
    };
    std::string command = "handhold run" + option("--scene", options.scene);
    if (!spawn.empty()) {
        command += option("--spawn", spawn);
    }
    command += " --players 1" + option("--input", options.record);
    if (hz != k_default_hz) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), " --hz %.17g", hz);
        command += text.data();
    }
    // The controller profile's hand poses were used to convert the samples, so the replay needs it
    // too.
    if (!options.models.controllers.empty()) {
        command += option("--controllers", options.models.controllers);
    }
    return command + (options.distance_grab ? " --distance-grab" : "");
}

Result<PlayedScene> load_played_scene(const PlayOptions& options) {
    Result<Scene> scene = load_scene_with_progress(options.scene);
    if (!scene) {
        return scene.error();
    }
    PlayedScene loaded{std::move(scene.value()), {}};
    const auto& spawns = loaded.scene.spawns;
    const auto found = std::ranges::find_if(spawns, [&](const SceneSpawnPoint& candidate) {
        return options.spawn.empty() || candidate.name == options.spawn;
    });
    if (found != spawns.end()) {
        loaded.place = *found;
    } else if (!options.spawn.empty()) {
        return FileError{options.scene, "/spawns",
                         "expected a spawn \"" + options.spawn + "\", found none of that name"};
    }
    hh::World& world = loaded.scene.host;
    if ((options.jets && !world.tune("locomotion.thruster_mps2", k_jets_mps2)) ||
        (options.distance_grab && !world.tune("pull.reach_m", k_pull_reach_m))) {
        return FileError{options.scene, "", hh_last_error()};
    }
    return loaded;
}

std::optional<FileError> check_play_files(const PlayOptions& options) {
    for (const std::string& file :
         {options.record, options.picture, options.report, options.status}) {
        if (auto error = check_folder(file)) {
            return error;
        }
    }
    return std::nullopt;
}

Result<OpenFile> open_status(const PlayOptions& options) {
    OpenFile file(options.status.empty() ? nullptr : std::fopen(options.status.c_str(), "w"));
    if (!options.status.empty() && file == nullptr) {
        return FileError{options.status, "", "expected a file that can be written"};
    }
    return file;
}

std::optional<FileError> save_play(const PlayOptions& options, const EndedPlay& play,
                                   const PlayTally& tally, const Image& image) {
    if (!options.record.empty() && play.recording.samples.size() > 1) {
        if (auto error = save_recording(options.record, play.recording)) {
            return error;
        }
        const std::string again = options.join.empty()
                                      ? replay_command(options, play.spawn, play.hz)
                                      : "handhold run --join " + shell_word(options.join) +
                                            " --input " + shell_word(options.record);
        std::printf("%s: %zu samples%s; to see it again:\n%s\n", printable(options.record).c_str(),
                    play.recording.samples.size(),
                    play.used_sticks ? ", without turns, brake and jets" : "", again.c_str());
    }
    if (!options.picture.empty() && image.width_px > 0) {
        if (auto error = save_png(image, options.picture)) {
            return error;
        }
    }
    if (!options.report.empty()) {
        const std::string hash = format_hash(play.scene.host.hash());
        return write_file_atomically(options.report, tally.report_json(play.scene.name, hash));
    }
    return std::nullopt;
}

}  // namespace handhold
