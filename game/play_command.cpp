#include "game/play_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "engine/io/text_file.hpp"
#include "game/exit_status.hpp"
#include "game/play_loop.hpp"
#include "game/player_defaults.hpp"
#include "game/report/run_summary.hpp"
#include "game/ui/hud.hpp"

namespace handhold {
namespace {

// Said before anything is played: a session that cannot be kept is not begun.
std::optional<FileError> check_folder(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return FileError{file.string(), "", "expected a folder that is there"};
    }
    return std::nullopt;
}

std::optional<FileError> save(const PlayOptions& options, const std::string& spawn,
                              const DesktopSession& session, const PlayTally& tally,
                              const Image& image) {
    const Recording& recording = session.recording();
    if (recording.samples.size() > 1) {
        if (auto error = save_recording(options.record, recording)) {
            return error;
        }
        std::printf("%s: %zu samples%s; to see it again:\n", options.record.c_str(),
                    recording.samples.size(),
                    session.used_sticks() ? ", without turns, brake and jets" : "");
        std::printf("handhold run --scene %s%s --players 1 --input %s\n", options.scene.c_str(),
                    spawn.empty() ? "" : (" --spawn " + spawn).c_str(), options.record.c_str());
    }
    if (!options.picture.empty() && image.width_px > 0 && !save_png(image, options.picture)) {
        return FileError{options.picture, "", "expected a file that can be written"};
    }
    if (!options.report.empty()) {
        const std::string hash = format_hash(hash_state(session.scene().world));
        return write_file_atomically(options.report, tally.report_json(session.scene().name, hash));
    }
    return std::nullopt;
}

struct LoadedScene {
    Scene scene;
    SceneSpawnPoint place;  // the origin where the scene names none
};

Result<LoadedScene> load(const PlayOptions& options) {
    Result<Scene> scene = load_scene(options.scene);
    if (!scene) {
        return scene.error();
    }
    LoadedScene loaded{std::move(scene.value()), {}};
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
    if (options.jets) {
        loaded.scene.tuning.locomotion.thruster_mps2 = k_jets_mps2;
    }
    return loaded;
}

int refuse_window(const std::string& why_not) {
    std::fprintf(stderr, "no window: %s\n", why_not.c_str());
    return k_exit_no_window;
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace

int play_command(PlayOptions options) {
    for (const std::string& file :
         {options.record, options.picture, options.report, options.status}) {
        if (const auto error = check_folder(file)) {
            return refuse(*error);
        }
    }
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    const OpenFile status(options.status.empty() ? nullptr
                                                 : std::fopen(options.status.c_str(), "w"));
    if (!options.status.empty() && status == nullptr) {
        return refuse({options.status, "", "expected a file that can be written"});
    }
    PlayPanels panels = options.panels;
    std::unique_ptr<Window> window;
    Overlay overlay(options.width_px, options.height_px);
    for (;;) {
        Result<LoadedScene> loaded = load(options);
        if (!loaded) {
            return refuse(loaded.error());
        }
        const std::string place = loaded.value().place.name;
        DesktopSession session(std::move(loaded.value().scene), loaded.value().place.pose_ws);
        if (models.value().controllers && models.value().controllers->has_own_joint) {
            session.set_controller_joints(models.value().controllers->joints());
        }
        if (!options.record.empty()) {
            session.record();
        }
        std::string why_not;
        auto view = PlayerView::open(session.scene(), models.value(), options.width_px,
                                     options.height_px, why_not, options.settings.quality);
        if (!view) {
            return refuse_window(why_not);
        }
        if (window == nullptr) {
            window = Window::open("", options.width_px, options.height_px, why_not);
            if (window == nullptr) {
                return refuse_window(why_not);
            }
            std::printf("%s\n", help_text());
        }
        window->set_title("Handhold: " + session.scene().name);
        Image picture;
        PlayTally tally;
        PlayStage stage{session,
                        *window,
                        *view,
                        models.value(),
                        overlay,
                        options.settings,
                        panels,
                        tally,
                        picture,
                        {options.width_px, options.height_px},
                        options.gizmos,
                        options.page,
                        options.viewpoint,
                        options.seconds,
                        status.get()};
        const PlayEnd end = play(stage);
        std::printf("%s", tally.summary().c_str());
        if (const auto error = save(options, place, session, tally, picture)) {
            return refuse(*error);
        }
        if (end.leaves) {
            std::printf("state_hash %s\n", format_hash(hash_state(session.scene().world)).c_str());
            return 0;
        }
        options.scene = end.scene;
        options.spawn.clear();
    }
}

}  // namespace handhold
