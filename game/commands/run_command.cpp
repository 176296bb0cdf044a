#include "game/commands/run_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/printable.hpp"
#include "engine/core/profile.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/climber/crowd.hpp"
#include "game/commands/output_folder.hpp"
#include "game/commands/run_output.hpp"
#include "game/commands/run_setup.hpp"
#include "game/commands/run_shots.hpp"
#include "game/commands/run_snapshot.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"
#include "game/play/progress.hpp"
#include "game/report/run_summary.hpp"
#include "game/report/state_size.hpp"
#include "game/run/session_run.hpp"
#include "game/session/interrupt.hpp"
#include "systems/snapshot/snapshot.hpp"

namespace handhold {
namespace {

RunLog play(Scene& scene, const std::vector<PlayerEntities>& players, const Recording* recording,
            const RunSettings& settings, RunFilm& film, RunTally& tally, SnapshotTaker& snapshots) {
    Progress progress("playing " + printable(scene.name, k_max_shown_name));
    const double length_s = session_length_s(recording, settings);
    return run_session(scene, player_ids(players), recording, settings,
                       [&](const Scene& played, const FrameLog& frame) {
                           snapshots.watch(played, frame.t_s);
                           film_frame(frame, film);
                           tally.add(frame);
                           progress.show(frame.t_s / length_s);
                       });
}

// A session that is ready for its first frame.
struct PreparedRun {
    std::optional<OutputFolder> out;  // the folder stays locked until the run ends
    Scene scene;
    PlayerModels models;
    RunSession session;
    StartPlace place;
    std::vector<PlayerEntities> players;
    std::unique_ptr<SnapshotAssets> assets;
    RunSettings settings;

    const Recording* recording() const { return session.recording ? &*session.recording : nullptr; }
    double length_s() const { return session_length_s(recording(), settings); }
};

// Loads the scene, the player models and the recordings, and opens the output folder.
std::optional<FileError> load_files(const RunOptions& options, PreparedRun& run) {
    Result<Scene> scene = load_scene_with_progress(options.scene);
    if (!scene) {
        return scene.error();
    }
    run.scene = std::move(scene.value());
    print_notes(run.scene.notes);
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return models.error();
    }
    run.models = std::move(models.value());
    print_notes(run.models.notes);
    Result<RunSession> session = load_session(options, run.scene);
    if (!session) {
        return session.error();
    }
    run.session = std::move(session.value());
    if (options.players > 0 &&
        static_cast<std::size_t>(options.players) < recorded_players(run.session)) {
        return FileError{options.scene, "",
                         "expected a player for each session, found " +
                             std::to_string(options.players) + " players"};
    }
    if (!options.out.empty()) {
        Result<OutputFolder> folder = OutputFolder::open(options.out);
        if (!folder) {
            return folder.error();
        }
        run.out.emplace(std::move(folder.value()));
    }
    load_game_body_clips(run.scene.host);
    return {};
}

// Adds the players at their places.
std::optional<FileError> place_players(const RunOptions& options, PreparedRun& run) {
    Result<StartPlace> place = choose_place(options, options.spawn, run.scene, run.recording());
    if (!place) {
        return place.error();
    }
    run.place = std::move(place.value());
    const Result<std::vector<StartPlace>> places =
        choose_places(options, run.place, run.scene, run.session);
    if (!places) {
        return places.error();
    }
    Result<std::vector<PlayerEntities>> players =
        add_players(run.scene, places.value(), options, run.session);
    if (!players) {
        return players.error();
    }
    run.players = std::move(players.value());
    warn_of_overlaps(run.scene, run.players);
    if (const auto joints = run.models.controller_joints()) {
        set_controller_joints(*joints, run.scene.host);
    }
    return {};
}

// Chooses the run's settings and checks the session's length. Restores the snapshot of --resume.
std::optional<FileError> set_start(const RunOptions& options, PreparedRun& run) {
    run.assets = std::make_unique<SnapshotAssets>(run.scene.shapes(), run.scene.name);
    run.settings = choose_settings(options, run.session, run.players.size(), run.scene);
    run.settings.should_stop = is_interrupted;
    for (const Recording& more : run.session.more) {
        run.settings.more_recordings.push_back(&more);
    }
    if (auto error = check_length(options, run.session.name, run.length_s())) {
        return error;
    }
    return resume_from_snapshot(options, run.settings, *run.assets, run.scene, run.players);
}

// Plays the session, writes its files and prints its summary. Returns the exit status.
int play_and_report(const RunOptions& options, PreparedRun& run) {
    RunFilm film = open_run_film(options, run.scene, std::move(run.models), run.length_s());
    if (!options.trace.empty()) {
        start_trace();
    }
    // Measured before the first frame, because a grip adds elements to columns while it lasts.
    const std::size_t bytes_per_player =
        run.players.empty() ? 0
                            : state_bytes(run.scene.host, player_id(run.players.front().player));
    RunTally tally;
    SnapshotTaker snapshots(options, *run.assets);
    RunLog log =
        play(run.scene, run.players, run.recording(), run.settings, film, tally, snapshots);
    if (const auto error = snapshots.error()) {
        return refuse(*error);
    }
    log.bytes_per_player = bytes_per_player;
    log.input = run.session.name;
    log.spawn = run.place.name;
    if (!options.trace.empty()) {
        stop_trace();
        if (const auto error = write_trace(options.trace)) {
            return refuse(*error);
        }
    }
    if (!options.out.empty()) {
        if (const auto error = write_run_output(options.out, log, film)) {
            return refuse(*error);
        }
    }
    print_run_summary(log, tally.finish(log));
    if (is_interrupted()) {
        std::printf("interrupted: the files are of the frames played so far\n");
    }
    if (run.scene.arena) {
        std::printf("score: %s\n", score_text(run.scene.arena->state).c_str());
    }
    std::printf("state_hash %s\n", format_hash(log.state_hash).c_str());
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace

int run_command(const RunOptions& options) {
    const InterruptGuard interrupts;
    PreparedRun run;
    for (auto* const prepare : {&load_files, &place_players, &set_start}) {
        if (const auto error = (*prepare)(options, run)) {
            return refuse(*error);
        }
    }
    if (!options.shots.empty()) {
        return draw_shots(options, {run.scene, run.players, run.recording(), run.settings},
                          std::move(run.models));
    }
    return play_and_report(options, run);
}

}  // namespace handhold
