#include "game/play_command.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "engine/core/profile.hpp"
#include "game/desktop_session.hpp"
#include "game/platform/window.hpp"
#include "game/player_view.hpp"
#include "game/report/run_summary.hpp"

namespace handhold {
namespace {

constexpr int k_exit_bad_file = 2;
constexpr int k_exit_no_window = 3;
constexpr double k_most_behind_s = 0.1;  // then time goes slower
constexpr double k_fov_rad = 1.25;
constexpr double k_jets_mps2 = 0.5;
constexpr const char* k_help =
    "Look about with the mouse. The mark is green where a hand can reach.\n"
    "Left, right button: that hand reaches, and grips while you hold it.\n"
    "W A S D, Q E: pull yourself by what you grip.\n"
    "Wheel: farther, nearer. Shift: faster. Space: brake.\n"
    "F1: this help. Esc: leave.";

int refuse(const FileError& error) {
    std::fprintf(stderr, "%s\n", error.message().c_str());
    return k_exit_bad_file;
}

// Real time into steps of the simulation: input that happened between two of them waits.
class Clock {
  public:
    // Steps that are due.
    int advance() {
        const std::int64_t now = now_ns();
        behind_s_ += last_ns_ != 0 ? 1e-9 * static_cast<double>(now - last_ns_) : 0.0;
        behind_s_ = std::min(behind_s_, k_most_behind_s);
        last_ns_ = now;
        const auto due = static_cast<int>(behind_s_ / DesktopSession::k_dt_s);
        behind_s_ -= due * DesktopSession::k_dt_s;
        return due;
    }

  private:
    std::int64_t last_ns_ = 0;
    double behind_s_ = 0.0;
};

// What came with one look at the window goes into the first of several steps, but for what is held.
void spend(DesktopInput& input) {
    input.turn_left_rad = input.look_up_rad = input.farther_m = 0.0;
    input.opened = {};
}
void gather(const DesktopInput& now, DesktopInput& input) {
    const DesktopInput before = input;
    input = now;
    input.turn_left_rad += before.turn_left_rad;
    input.look_up_rad += before.look_up_rad;
    input.farther_m += before.farther_m;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        input.opened[side] = input.opened[side] || before.opened[side];
    }
}

void play(const PlayOptions& options, DesktopSession& session, Window& window, PlayerView& view,
          Image& image) {
    Clock clock;
    DesktopInput input;
    bool shows_help = true;
    const World& world = session.scene().world;
    const double end_s = options.seconds > 0.0 ? options.seconds : HUGE_VAL;
    for (bool quits = false; !quits && world.clock.t_s < end_s;) {
        const WindowEvents events = window.poll();
        gather(events.input, input);
        shows_help = shows_help != events.help;
        quits = events.quit;
        const int due = clock.advance();
        if (due == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        for (int i = 0; i < due && world.clock.t_s < end_s; ++i) {
            session.step(input);
            spend(input);
        }
        const Entity player = session.player().player;
        view.draw(world.render_pose.at(player).head_ws, k_fov_rad,
                  world.render_pose.find_row(player), image);
        window.show(image, session.body().can_reach(), shows_help ? k_help : "");
    }
}

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
                              const DesktopSession& session, const Image& image) {
    const Recording& recording = session.recording();
    if (recording.samples.size() > 1) {
        if (auto error = save_recording(options.record, recording)) {
            return error;
        }
        std::printf("%s: %zu samples%s; to see it again:\n", options.record.c_str(),
                    recording.samples.size(),
                    session.used_sticks() ? ", without brake and jets" : "");
        std::printf("handhold run --scene %s%s --players 1 --input %s\n", options.scene.c_str(),
                    spawn.empty() ? "" : (" --spawn " + spawn).c_str(), options.record.c_str());
    }
    if (!options.picture.empty() && image.width_px > 0 && !save_png(image, options.picture)) {
        return FileError{options.picture, "", "expected a file that can be written"};
    }
    return std::nullopt;
}

}  // namespace

int play_command(const PlayOptions& options) {
    for (const std::string& file : {options.record, options.picture}) {
        if (const auto error = check_folder(file)) {
            return refuse(*error);
        }
    }
    Result<Scene> loaded = load_scene(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    SceneSpawnPoint place;  // the origin where the scene names none
    const auto& spawns = loaded.value().spawns;
    const auto found = std::ranges::find_if(spawns, [&](const SceneSpawnPoint& candidate) {
        return options.spawn.empty() || candidate.name == options.spawn;
    });
    if (found != spawns.end()) {
        place = *found;
    } else if (!options.spawn.empty()) {
        return refuse({options.scene, "/spawns",
                       "expected a spawn \"" + options.spawn + "\", found none of that name"});
    }
    if (options.jets) {
        loaded.value().tuning.locomotion.thruster_mps2 = k_jets_mps2;
    }
    DesktopSession session(std::move(loaded.value()), place.pose_ws);
    if (!options.record.empty()) {
        session.record();
    }
    std::string why_not;
    Result<HandModels> hands = choose_hand_models(options.hand_rig);
    if (!hands) {
        return refuse(hands.error());
    }
    auto view = PlayerView::open(session.scene(), std::move(hands.value()), options.width_px,
                                 options.height_px, why_not);
    const auto window = view ? Window::open("Handhold: " + session.scene().name, options.width_px,
                                            options.height_px, why_not)
                             : nullptr;
    if (window == nullptr) {
        std::fprintf(stderr, "no window: %s\n", why_not.c_str());
        return k_exit_no_window;
    }
    std::printf("%s\n", k_help);
    Image image;
    play(options, session, *window, *view, image);
    if (const auto error = save(options, place.name, session, image)) {
        return refuse(*error);
    }
    std::printf("state_hash %s\n", format_hash(hash_state(session.scene().world)).c_str());
    return 0;
}

}  // namespace handhold
