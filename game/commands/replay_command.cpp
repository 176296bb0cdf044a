#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "game/commands/match_commands.hpp"
#include "game/commands/match_entry.hpp"
#include "game/commands/output_folder.hpp"
#include "game/commands/run_shots.hpp"
#include "game/net/match_replay.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/progress.hpp"
#include "game/report/run_summary.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {

namespace {

// Null: nothing is drawn.
Result<std::unique_ptr<ShotFilm>> open_film(const RunOptions& drawn, const Scene& scene) {
    if (drawn.shots.empty()) {
        return std::unique_ptr<ShotFilm>();
    }
    Result<PlayerModels> models = choose_player_models(drawn.models);
    if (!models) {
        return models.error();
    }
    return open_shots(drawn, scene.name, scene, std::move(models.value()));
}

}  // namespace

int replay_command(const ReplayOptions& options, const RunOptions& drawn) {
    const InterruptGuard interrupts;
    const Result<MatchRecording> recording = load_match_recording(options.file);
    if (!recording) {
        return refuse(recording.error());
    }
    const MatchOffer& level = recording.value().level;
    Result<MatchScene> made = load_entry_scene({options.file, options.scene, ""}, level);
    if (!made) {
        return refuse(made.error());
    }
    Scene& scene = made.value().scene;
    MatchReplay replay(scene.host, made.value().players, scene.arena ? &*scene.arena : nullptr,
                       recording.value(), k_match_tick_s);
    constexpr double k_after_s = 0.1;
    std::optional<OutputFolder> folder;
    if (!drawn.out.empty()) {
        Result<OutputFolder> opened = OutputFolder::open(drawn.out);
        if (!opened) {
            return refuse(opened.error());
        }
        folder.emplace(std::move(opened.value()));
    }
    const Result<std::unique_ptr<ShotFilm>> film = open_film(drawn, scene);
    if (!film) {
        return refuse(film.error());
    }
    const double length_s =
        film.value() != nullptr ? film.value()->length_s() + k_after_s : options.seconds;
    std::uint64_t ticks = 0;
    {
        Progress progress("playing " + printable(level.scene));
        const double last = static_cast<double>(recording.value().last_tick);
        while (!is_interrupted() &&
               (length_s == 0.0 || static_cast<double>(ticks) * k_match_tick_s < length_s)) {
            const Result<bool> stepped = replay.step(film.value() != nullptr);
            if (!stepped) {
                return refuse(stepped.error());
            }
            if (!stepped.value()) {
                break;
            }
            ++ticks;
            if (film.value() != nullptr) {
                film.value()->watch(static_cast<double>(ticks) * k_match_tick_s);
            }
            progress.show(last > 0.0 ? static_cast<double>(replay.tick()) / last : 1.0);
        }
    }
    const int status = film.value() != nullptr ? finish_shots(scene.name, *film.value()) : 0;
    std::printf("played %llu ticks to tick %llu; %llu hashes of the recording are equal\n",
                static_cast<unsigned long long>(ticks),
                static_cast<unsigned long long>(replay.tick()),
                static_cast<unsigned long long>(replay.compared()));
    if (scene.arena) {
        std::printf("score: %s\n", score_text(scene.arena->state).c_str());
    }
    std::printf("state_hash %s\n", format_hash(*replay.match().hash(replay.tick())).c_str());
    return is_interrupted() ? k_exit_interrupted : status;
}

}  // namespace handhold
