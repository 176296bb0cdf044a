#include "game/play_command.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "engine/core/profile.hpp"
#include "game/desktop_body.hpp"
#include "game/place_scene.hpp"
#include "game/platform/window.hpp"
#include "game/player_view.hpp"
#include "game/recording.hpp"
#include "game/report/run_summary.hpp"
#include "systems/frame.hpp"

namespace handhold {
namespace {

constexpr int k_exit_bad_file = 2;
constexpr int k_exit_no_window = 3;
constexpr double k_dt_s = 1.0 / 90.0;
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

RecordedSample recorded(const TrackingSample& sample) {
    RecordedSample out{sample.t_s, sample.head_ps, {}};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ControllerSample& controller = sample.controllers[side];
        out.hands[side] = {controller.controller_ps, controller.grab ? k_button_grip : 0,
                           controller.grab ? 1.0 : 0.0};
    }
    return out;
}

// A scene with one player at the desk.
struct Game {
    Scene scene;
    FrameCaches caches;
    PlayerEntities player;
    DesktopBody body;
    Recording recording;
    bool has_used_sticks = false;

    Game(Scene loaded, const Pose& origin_ws)
        : scene(std::move(loaded)),
          caches(*scene.shapes),
          player(add_scene_player(scene,
                                  {free_player_name(scene.world, "player0"), origin_ws, 80.0})) {}

    void step(const DesktopInput& input) {
        place_scene(scene, caches);
        const double start_s = scene.world.clock.t_s;
        std::vector<TrackingSample> samples;
        if (recording.samples.empty()) {  // recordings begin with the session
            samples.push_back(body.advance(scene, caches.collision, player, {}, start_s, 1e-9));
        }
        samples.push_back(
            body.advance(scene, caches.collision, player, input, start_s + k_dt_s, k_dt_s));
        for (const TrackingSample& sample : samples) {
            recording.samples.push_back(recorded(sample));
        }
        has_used_sticks = has_used_sticks || input.brake ||
                          (scene.tuning.locomotion.thruster_mps2 > 0.0 && !input.move.isZero());
        const PlayerInput from{player.player, samples, body.commands(input)};
        StageStats stats;
        step_frame(scene.world, caches, scene.tuning, {k_dt_s, {&from, 1}}, stats);
    }
};

// Real time into steps of the simulation: input that happened between two of them waits.
class Clock {
  public:
    // Steps that are due.
    int advance() {
        const std::int64_t now = now_ns();
        behind_s_ += last_ns_ != 0 ? 1e-9 * static_cast<double>(now - last_ns_) : 0.0;
        behind_s_ = std::min(behind_s_, k_most_behind_s);
        last_ns_ = now;
        const auto due = static_cast<int>(behind_s_ / k_dt_s);
        behind_s_ -= due * k_dt_s;
        return due;
    }

  private:
    std::int64_t last_ns_ = 0;
    double behind_s_ = 0.0;
};

// What came with one look at the window goes into the first of several steps, but for what is held.
void spend(DesktopInput& input) { input.turn_left_rad = input.look_up_rad = input.farther_m = 0.0; }
void gather(const DesktopInput& now, DesktopInput& input) {
    const DesktopInput before = input;
    input = now;
    input.turn_left_rad += before.turn_left_rad;
    input.look_up_rad += before.look_up_rad;
    input.farther_m += before.farther_m;
}

void play(const PlayOptions& options, Game& game, Window& window, PlayerView& view, Image& image) {
    Clock clock;
    DesktopInput input;
    bool shows_help = true;
    const double end_s = options.seconds > 0.0 ? options.seconds : HUGE_VAL;
    for (bool quits = false; !quits && game.scene.world.clock.t_s < end_s;) {
        const WindowEvents events = window.poll();
        gather(events.input, input);
        shows_help = shows_help != events.help;
        quits = events.quit;
        const int due = clock.advance();
        if (due == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        for (int i = 0; i < due && game.scene.world.clock.t_s < end_s; ++i) {
            game.step(input);
            spend(input);
        }
        const RenderPose& eyes = game.scene.world.render_pose.at(game.player.player);
        const std::size_t row = game.scene.world.render_pose.find_row(game.player.player);
        view.draw(eyes.head_ws, k_fov_rad, row, image);
        window.show(image, game.body.can_reach(), shows_help ? k_help : "");
    }
}

std::optional<FileError> save(const PlayOptions& options, const Game& game, const Image& image) {
    if (!options.record.empty()) {
        if (auto error = save_recording(options.record, game.recording)) {
            return error;
        }
        std::printf("%s: %zu samples%s\n", options.record.c_str(), game.recording.samples.size(),
                    game.has_used_sticks ? "; brake and jets are not in it" : "");
    }
    if (!options.picture.empty() && !save_png(image, options.picture)) {
        return FileError{options.picture, "", "expected a file that can be written"};
    }
    return std::nullopt;
}

}  // namespace

int play_command(const PlayOptions& options) {
    Result<Scene> loaded = load_scene(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    const auto& spawns = loaded.value().spawns;
    const auto spawn = std::ranges::find_if(spawns, [&](const SceneSpawnPoint& candidate) {
        return options.spawn.empty() || candidate.name == options.spawn;
    });
    if (spawn == spawns.end() && !options.spawn.empty()) {
        return refuse({options.scene, "/spawns",
                       "expected a spawn \"" + options.spawn + "\", found none of that name"});
    }
    const Pose origin_ws = spawn != spawns.end() ? spawn->pose_ws : Pose{};
    Game game(std::move(loaded.value()), origin_ws);
    if (options.jets) {
        game.scene.tuning.locomotion.thruster_mps2 = k_jets_mps2;
    }
    std::string why_not;
    auto view = PlayerView::open(game.scene, options.width_px, options.height_px, why_not);
    const auto window = view ? Window::open("Handhold: " + game.scene.name, options.width_px,
                                            options.height_px, why_not)
                             : nullptr;
    if (window == nullptr) {
        std::fprintf(stderr, "no window: %s\n", why_not.c_str());
        return k_exit_no_window;
    }
    std::printf("%s\n", k_help);
    Image image;
    play(options, game, *window, *view, image);
    if (const auto error = save(options, game, image)) {
        return refuse(*error);
    }
    std::printf("state_hash %s\n", format_hash(hash_state(game.scene.world)).c_str());
    return 0;
}

}  // namespace handhold
