// handhold-scenes: plays the game's scenes without its window and pictures, and prints the state
// hash of each. tools/cross compares what it prints on two targets.
//
// usage: handhold-scenes SECONDS [SCENE [RECORDING]]...
//   Without SCENE: all built-in scenes. "-" as RECORDING: the scene's own session.
// Prints a line "SCENE 0x<16 hex digits> MEDIAN_US" for each, the median time of a step, and for
// scenes without scripted climbers a line "SCENE/rollback 0x... 0.0": the second half of the
// session played again from a snapshot, which must give the same hash. Exit status 0; 1: a hash
// differs after the rollback; 2: a scene or a recording cannot be loaded.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "game/assets/body_clips_asset.hpp"
#include "game/commands/run_setup.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/levels/load_scene.hpp"
#include "game/run/session_run.hpp"
#include "systems/snapshot/snapshot.hpp"

namespace handhold {
namespace {

[[noreturn]] void refuse(const FileError& error) {
    std::fprintf(stderr, "%s\n", error.message().c_str());
    std::exit(2);
}

template <typename T>
T value_or_exit(Result<T> result) {
    if (!result) {
        refuse(result.error());
    }
    return std::move(result.value());
}

// A scene with its players, as `handhold run --scene SCENE --input RECORDING` begins.
struct Ready {
    explicit Ready(const RunOptions& options)
        : scene(value_or_exit(load_scene(options.scene))),
          session(value_or_exit(load_session(options, scene))) {
        load_game_body_clips(scene.host);
        const StartPlace place =
            value_or_exit(choose_place(options, options.spawn, scene, recording()));
        const std::vector<StartPlace> places =
            value_or_exit(choose_places(options, place, scene, session));
        players = value_or_exit(add_players(scene, places, options, session));
        settings = choose_settings(options, session, players.size(), scene);
        settings.keep_frames = false;
    }
    const Recording* recording() const { return session.recording ? &*session.recording : nullptr; }

    Scene scene;
    RunSession session;
    std::vector<PlayerEntities> players;
    RunSettings settings;
};

void print_line(const std::string& name, std::uint64_t hash, double step_us) {
    std::printf("%s 0x%016" PRIx64 " %.1f\n", name.c_str(), hash, step_us);
    std::fflush(stdout);
}

// Returns false if a rollback gives another hash.
bool play(const RunOptions& options) {
    Ready ready(options);
    const SnapshotAssets assets(ready.scene.shapes(), ready.scene.name);
    const bool rolls_back = ready.settings.climbers_from >= ready.players.size();
    const double half_s = 0.5 * session_length_s(ready.recording(), ready.settings);
    std::vector<std::byte> snapshot;
    std::vector<double> steps_us;
    const auto watch = [&](const Scene& scene, const FrameLog& frame) {
        const auto& stages = frame.stats.stage_us;
        steps_us.push_back(std::accumulate(stages.begin(), stages.end(), 0.0));
        if (rolls_back && snapshot.empty() && frame.t_s >= half_s) {
            save_snapshot(scene.world(), assets, snapshot);
        }
    };
    const auto run = [&] {
        return run_session(ready.scene, player_ids(ready.players), ready.recording(),
                           ready.settings, watch)
            .state_hash;
    };
    const std::uint64_t hash = run();
    const auto middle = steps_us.begin() + static_cast<std::ptrdiff_t>(steps_us.size() / 2);
    std::nth_element(steps_us.begin(), middle, steps_us.end());
    print_line(options.scene, hash, *middle);
    if (!rolls_back) {
        return true;
    }
    if (const auto error = restore_snapshot(snapshot, assets, ready.scene.world())) {
        refuse(*error);
    }
    const std::uint64_t again = run();
    print_line(options.scene + "/rollback", again, 0.0);
    return again == hash;
}

int main_of(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "usage: handhold-scenes SECONDS [SCENE [RECORDING]]...\n");
        return 2;
    }
    std::vector<RunOptions> runs;
    for (int i = 2; i < count; i += 2) {
        RunOptions options;
        options.scene = words[i];
        const std::string recording = i + 1 < count ? words[i + 1] : "-";
        options.input = recording == "-" ? "" : recording;
        runs.push_back(std::move(options));
    }
    if (runs.empty()) {
        for (const std::string_view name : built_in_scenes()) {
            runs.emplace_back().scene = name;
        }
    }
    bool all_equal = true;
    for (RunOptions& options : runs) {
        options.seconds = std::atof(words[1]);
        all_equal = play(options) && all_equal;
    }
    return all_equal ? 0 : 1;
}

}  // namespace
}  // namespace handhold

int main(int count, char** words) { return handhold::main_of(count, words); }
