#include "game/commands/play_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "game/commands/headset_command.hpp"
#include "game/commands/play_files.hpp"
#include "game/desktop/play_loop.hpp"
#include "game/play/exit_status.hpp"
#include "game/report/run_summary.hpp"
#include "game/ui/hud.hpp"

namespace handhold {
namespace {

int refuse_window(const std::string& why_not) {
    std::fprintf(stderr, "no window: %s\n", why_not.c_str());
    return k_exit_no_window;
}

// What stays from scene to scene.
struct PlayProgram {
    PlayOptions options;
    PlayerModels models;
    OpenFile status;
    PlayPanels panels;
    Overlay overlay;
    std::unique_ptr<Window> window;
};

// Opens the view of the session, and the window if it is not open yet. If graphics are not
// available, returns nullopt and sets `why_not`.
std::optional<PlayerView> open_view(PlayProgram& program, DesktopSession& session,
                                    std::string& why_not) {
    const PlayOptions& options = program.options;
    auto view = PlayerView::open(session.scene(), program.models, options.width_px,
                                 options.height_px, why_not, options.settings.quality);
    if (view && program.window == nullptr) {
        program.window = Window::open("", options.width_px, options.height_px, why_not);
        if (program.window == nullptr) {
            return {};
        }
        std::printf("%s\n", help_text());
    }
    return view;
}

// Plays the scene that the options name, until the user leaves it. Returns the exit status, or
// nullopt if options.scene names the next scene to play.
std::optional<int> play_scene(PlayProgram& program) {
    PlayOptions& options = program.options;
    Result<PlayedScene> loaded = load_played_scene(options);
    if (!loaded) {
        return refuse(loaded.error());
    }
    print_notes(loaded.value().scene.notes);
    const std::string place = loaded.value().place.name;
    DesktopSession session(std::move(loaded.value().scene), loaded.value().place.pose_ws);
    if (const auto joints = program.models.controller_joints()) {
        session.set_controller_joints(*joints);
    }
    if (!options.record.empty()) {
        session.record();
    }
    std::string why_not;
    auto view = open_view(program, session, why_not);
    if (!view) {
        return refuse_window(why_not);
    }
    program.window->set_title("Handhold: " + session.scene().name);
    Image picture;
    PlayTally tally;
    PlayStage stage{session,
                    *program.window,
                    *view,
                    program.models,
                    program.overlay,
                    options.settings,
                    program.panels,
                    tally,
                    picture,
                    {options.width_px, options.height_px},
                    options.gizmos,
                    options.page,
                    options.viewpoint,
                    options.seconds,
                    program.status.get()};
    const PlayEnd end = play(stage);
    std::printf("%s", tally.summary().c_str());
    if (const auto error = save_play(options,
                                     {session.scene(), place, session.recording(),
                                      session.used_sticks(), 1.0 / DesktopSession::k_dt_s},
                                     tally, picture)) {
        return refuse(*error);
    }
    if (end.leaves) {
        std::printf("state_hash %s\n", format_hash(session.world().hash()).c_str());
        return 0;
    }
    options.scene = end.scene;
    options.spawn.clear();
    return {};
}

}  // namespace

int play_command(const PlayOptions& options) {
    if (options.xr || options.xr_headless) {
        return headset_command(options);
    }
    if (const auto error = check_play_files(options)) {
        return refuse(*error);
    }
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    print_notes(models.value().notes);
    Result<OpenFile> status = open_status(options);
    if (!status) {
        return refuse(status.error());
    }
    PlayProgram program{options,
                        std::move(models.value()),
                        std::move(status.value()),
                        options.panels,
                        Overlay(options.width_px, options.height_px),
                        nullptr};
    for (;;) {
        if (const auto exit_status = play_scene(program)) {
            return *exit_status;
        }
    }
}

}  // namespace handhold
