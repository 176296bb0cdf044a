#include "game/commands/headset_command.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "game/commands/play_files.hpp"
#include "game/headset/headset_loop.hpp"
#include "game/play/exit_status.hpp"
#include "game/report/run_summary.hpp"

namespace handhold {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;
void ask_to_end(int) { asked_to_end = 1; }

int refuse_headset(const std::string& why_not) {
    std::fprintf(stderr, "play --xr: %s\n", why_not.c_str());
    return k_exit_no_window;
}

// The recommended eye size times `scale`, at most the XR runtime's limit.
EyeSize scaled(const EyeSizes& sizes, double scale) {
    const auto along = [scale](int pixels, int most) {
        return std::min(std::max(static_cast<int>(std::lround(scale * pixels)), 16), most);
    };
    return {along(sizes.recommended.width_px, sizes.largest.width_px),
            along(sizes.recommended.height_px, sizes.largest.height_px)};
}

// What draws the eyes' pictures and shows the mirror window.
struct Eyes {
    std::optional<PlayerView> view;
    std::unique_ptr<Window> mirror;  // null: switched off, or unavailable
    EyeSize size;
};
// nullopt, with the reason in `why_not`, if nothing can be drawn. If only the mirror cannot be
// opened, prints a message and goes on without it.
std::optional<Eyes> open_eyes(const PlayOptions& options, const Scene& scene,
                              const PlayerModels& models, const Headset& headset,
                              std::string& why_not) {
    Eyes eyes;
    eyes.size = scaled(headset.eye_sizes(), options.eye_scale);
    if (eyes.size.width_px <= 0 || eyes.size.height_px <= 0) {
        why_not = "the OpenXR runtime does not say how large its pictures are";
        return std::nullopt;
    }
    eyes.view = PlayerView::open(scene, models, eyes.size.width_px, eyes.size.height_px, why_not,
                                 options.settings.quality);
    if (!eyes.view) {
        return std::nullopt;
    }
    if (options.mirror) {
        std::string no_mirror;
        eyes.mirror =
            Window::open("Handhold: " + scene.name, options.width_px, options.height_px, no_mirror);
        if (eyes.mirror != nullptr) {
            eyes.mirror->hold_mouse(false);
        } else {
            std::fprintf(stderr, "no mirror of the headset: %s\n", no_mirror.c_str());
        }
    }
    return eyes;
}

}  // namespace

int headset_command(const PlayOptions& options) {
    if (const auto error = check_play_files(options)) {
        return refuse(*error);
    }
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    print_notes(models.value().notes);
    Result<PlayedScene> loaded = load_played_scene(options);
    if (!loaded) {
        return refuse(loaded.error());
    }
    print_notes(loaded.value().scene.notes);
    const Result<OpenFile> status = open_status(options);
    if (!status) {
        return refuse(status.error());
    }
    std::string why_not;
    std::unique_ptr<Headset> headset = Headset::open(options.xr_headless, why_not);
    if (headset == nullptr) {
        return refuse_headset(why_not);
    }
    const std::string place = loaded.value().place.name;
    HeadsetSession session(std::move(loaded.value().scene), loaded.value().place.pose_ws);
    if (const auto joints = models.value().controller_joints()) {
        session.set_controller_joints(*joints);
    }
    if (!options.record.empty()) {
        session.record();
    }
    std::optional<Eyes> eyes = Eyes{};
    if (!options.xr_headless) {
        eyes = open_eyes(options, session.scene(), models.value(), *headset, why_not);
        if (!eyes) {
            return refuse_headset(why_not);
        }
    }
    std::signal(SIGINT, ask_to_end);
    std::signal(SIGTERM, ask_to_end);
    PlayTally tally;
    Image picture;
    HeadsetStage stage{options,
                       session,
                       eyes->view ? &*eyes->view : nullptr,
                       eyes->mirror.get(),
                       eyes->size,
                       tally,
                       picture,
                       status.value().get(),
                       &asked_to_end};
    const bool left = play_in_headset(stage, std::move(headset), why_not);
    std::printf("%s", tally.summary().c_str());
    if (const auto error = save_play(
            options, {session.scene(), place, session.recording(), session.used_sticks(), stage.hz},
            tally, picture)) {
        return refuse(*error);
    }
    if (!left) {
        return refuse_headset(why_not);
    }
    std::printf("state_hash %s\n", format_hash(session.world().hash()).c_str());
    return 0;
}

}  // namespace handhold
