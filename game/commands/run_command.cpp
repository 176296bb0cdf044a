#include "game/commands/run_command.hpp"

#include <cstdio>
#include <optional>
#include <utility>

#include "engine/core/profile.hpp"
#include "engine/io/printable.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/climber/crowd.hpp"
#include "game/commands/exit_status.hpp"
#include "game/commands/loading.hpp"
#include "game/commands/output_folder.hpp"
#include "game/commands/progress.hpp"
#include "game/commands/run_output.hpp"
#include "game/commands/run_setup.hpp"
#include "game/commands/run_shots.hpp"
#include "game/commands/run_snapshot.hpp"
#include "game/report/run_summary.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/session/interrupt.hpp"
#include "game/session/session_run.hpp"
#include "systems/snapshot.hpp"

namespace handhold {
namespace {

// Climbers need jets to return to a hold, so a scene without jets gets weak ones.
RunSettings choose_settings(const RunOptions& options, Scene& scene, std::size_t players) {
    RunSettings settings{options.hz, options.seconds, options.threads};
    settings.climbers_from = options.climbers ? 0 : recorded_players(options);
    settings.seed = options.seed;
    settings.keep_frames = !options.out.empty();
    settings.should_stop = is_interrupted;
    if (options.distance_grab) {
        scene.tuning.pull.reach_m = k_pull_reach_m;
    }
    double& jets_mps2 = scene.tuning.locomotion.thruster_mps2;
    if (players > settings.climbers_from && jets_mps2 == 0.0) {
        jets_mps2 = k_jets_mps2;
    }
    return settings;
}

RunLog play(Scene& scene, FrameCaches& caches, const std::vector<PlayerEntities>& players,
            const Recording* recording, const RunSettings& settings, SessionFilm* camera,
            RunTally& tally, SnapshotTaker& snapshots) {
    Progress progress("playing " + printable(scene.name, k_max_shown_name));
    const double length_s = session_length_s(recording, settings);
    return run_session(scene, caches, players, recording, settings,
                       [&](const Scene& played, const FrameLog& frame) {
                           snapshots.watch(played, frame.t_s);
                           if (camera != nullptr) {
                               camera->watch(frame);
                           }
                           tally.add(frame);
                           progress.show(frame.t_s / length_s);
                       });
}

}  // namespace

int run_command(const RunOptions& options) {
    const InterruptGuard interrupts;
    if (options.players > 0 &&
        static_cast<std::size_t>(options.players) < recorded_players(options)) {
        return refuse({options.scene, "",
                       "expected a player for each --input, found " +
                           std::to_string(options.players) + " players"});
    }
    Result<Scene> loaded = load_scene_with_progress(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    Scene& scene = loaded.value();
    print_notes(scene.notes);
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    print_notes(models.value().notes);
    const Result<RunSession> session = load_session(options, scene);
    if (!session) {
        return refuse(session.error());
    }
    std::optional<OutputFolder> out;  // the folder stays locked until the run ends
    if (!options.out.empty()) {
        Result<OutputFolder> folder = OutputFolder::open(options.out);
        if (!folder) {
            return refuse(folder.error());
        }
        out.emplace(std::move(folder.value()));
    }
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    caches.body_clips = game_body_clips();
    const Recording* const recording =
        session.value().recording ? &*session.value().recording : nullptr;
    const Result<StartPlace> place = choose_place(options, options.spawn, scene, caches, recording);
    if (!place) {
        return refuse(place.error());
    }
    const Result<std::vector<StartPlace>> places =
        choose_places(options, place.value(), scene, caches, session.value());
    if (!places) {
        return refuse(places.error());
    }
    Result<std::vector<PlayerEntities>> players =
        add_players(scene, caches, places.value(), options);
    if (!players) {
        return refuse(players.error());
    }
    warn_of_overlaps(scene, caches, players.value());
    if (const auto joints = models.value().controller_joints()) {
        set_controller_joints(*joints, scene.world);
    }
    const SnapshotAssets assets(*scene.shapes, scene.name);
    RunSettings settings = choose_settings(options, scene, players.value().size());
    for (const Recording& more : session.value().more) {
        settings.more_recordings.push_back(&more);
    }
    if (const auto error =
            check_length(options, session.value().name, session_length_s(recording, settings))) {
        return refuse(*error);
    }
    if (const auto error =
            resume_from_snapshot(options, settings, assets, scene, players.value())) {
        return refuse(*error);
    }

    if (!options.shots.empty()) {
        return draw_shots(options, {scene, caches, players.value(), recording, settings},
                          std::move(models.value()));
    }
    RunFilm film = open_run_film(options, scene, std::move(models.value()),
                                 session_length_s(recording, settings));
    if (!options.trace.empty()) {
        start_trace();
    }
    RunTally tally;
    SnapshotTaker snapshots(options, assets);
    RunLog log = play(scene, caches, players.value(), recording, settings, film.camera.get(), tally,
                      snapshots);
    if (const auto error = snapshots.error()) {
        return refuse(*error);
    }
    log.input = session.value().name;
    log.spawn = place.value().name;
    if (!options.trace.empty()) {
        stop_trace();
        if (const auto error = write_trace(options.trace)) {
            return refuse(*error);
        }
    }
    if (!options.out.empty()) {
        std::vector<FilmShot> shots = finish_run_film(film);
        if (auto error =
                write_run_output(options.out, log, std::move(film.media), std::move(shots))) {
            return refuse(*error);
        }
    }
    print_run_summary(log, tally.finish(log));
    if (is_interrupted()) {
        std::printf("interrupted: the files are of the frames played so far\n");
    }
    std::printf("state_hash %s\n", format_hash(log.state_hash).c_str());
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace handhold
