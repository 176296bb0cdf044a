#include "game/commands/run_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "engine/core/profile.hpp"
#include "engine/io/text_file.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/climber/crowd.hpp"
#include "game/commands/exit_status.hpp"
#include "game/commands/progress.hpp"
#include "game/render/image.hpp"
#include "game/report/frames_csv.hpp"
#include "game/report/report_html.hpp"
#include "game/report/report_json.hpp"
#include "game/report/run_summary.hpp"
#include "game/scene/built_in_scenes.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/scene/spawn.hpp"
#include "game/session/session_run.hpp"
#include "game/view/film.hpp"
#include "game/view/run_shots.hpp"
#include "systems/snapshot.hpp"

namespace handhold {
namespace {

struct Session {
    std::optional<Recording> recording;
    std::string name;  // file, "built-in <name>", or empty
};

// What drives the players: the given file, else the scene's own session, else nothing.
Result<Session> load_session(const RunOptions& options, const Scene& scene) {
    Session session;
    std::filesystem::path file = options.input;
    if (file.empty() && scene.session) {
        if (!scene.session->built_in.empty()) {
            session.recording = make_built_in_session(scene.session->built_in);
            if (!session.recording) {
                return FileError{options.scene, "/session",
                                 "expected the name of a built-in session, found \"" +
                                     scene.session->built_in + "\""};
            }
            session.name = "built-in " + scene.session->built_in;
            return session;
        }
        file = scene.session->file;
    }
    if (file.empty()) {
        return session;
    }
    Result<Recording> recording = load_recording(file);
    if (!recording) {
        return recording.error();
    }
    session.recording = std::move(recording.value());
    session.name = file.filename().string();
    return session;
}

struct Place {
    Pose origin_ws;
    std::string name;
};

Result<Place> choose_place(const RunOptions& options, const Scene& scene, FrameCaches& caches,
                           const Session& session) {
    if (options.spawn == "auto") {
        if (!session.recording) {
            return FileError{options.scene, "", "expected a session for --spawn auto, found none"};
        }
        const FoundSpawn found = find_spawn(scene, caches, *session.recording, options.hz);
        const Vec3& at = found.origin_ws.position;
        std::printf("spawn auto: %.3f %.3f %.3f, %zu of %zu grabs grip when tried\n", at.x(),
                    at.y(), at.z(), found.gripped, found.onsets);
        return Place{found.origin_ws, "auto"};
    }
    for (const SceneSpawnPoint& spawn : scene.spawns) {
        if (options.spawn.empty() || spawn.name == options.spawn) {
            return Place{spawn.pose_ws, spawn.name};
        }
    }
    if (!options.spawn.empty()) {
        std::string names;
        for (const SceneSpawnPoint& spawn : scene.spawns) {
            names += spawn.name + ", ";
        }
        return FileError{options.scene, "/spawns",
                         "expected " + names + "or auto, found \"" + options.spawn + "\""};
    }
    return Place{{}, "origin"};
}

// The scene's own players where it has some and neither place nor number was asked for; else the
// first at the place, the others spread over the scene.
Result<std::vector<PlayerEntities>> add_players(Scene& scene, FrameCaches& caches,
                                                const Place& place, const RunOptions& options) {
    std::vector<ScenePlayerStart> starts;
    if (!scene.players.empty() && options.spawn.empty() && options.players == 0) {
        starts = scene.players;
    } else {
        const auto count =
            static_cast<std::size_t>(options.players > 0 ? options.players : 1 + scene.climbers);
        for (const Pose& origin_ws :
             spread_players(scene, caches, place.origin_ws, count, options.seed)) {
            const std::string name = "player" + std::to_string(starts.size());
            starts.push_back({free_player_name(scene.world, name), origin_ws, 80.0});
        }
        if (starts.size() < count) {
            return FileError{options.scene, "",
                             "expected room for " + std::to_string(count) +
                                 " players, found it for " + std::to_string(starts.size())};
        }
    }
    std::vector<PlayerEntities> players;
    players.reserve(starts.size());
    for (const ScenePlayerStart& start : starts) {
        players.push_back(add_scene_player(scene, start));
    }
    return players;
}

// Saves the state when its time has come.
class SnapshotTaker {
  public:
    SnapshotTaker(const RunOptions& options, const SnapshotAssets& assets)
        : options_(options), assets_(assets) {}

    void watch(const Scene& scene, double t_s) {
        constexpr double k_rounding_s = 1e-9;
        if (!options_.snapshot.empty() && !taken_ && t_s >= options_.snapshot_at_s - k_rounding_s) {
            taken_ = true;
            error_ = save_snapshot_file(options_.snapshot, scene.world, assets_);
        }
    }
    // After the session.
    std::optional<FileError> error() const {
        if (!options_.snapshot.empty() && !taken_) {
            return FileError{options_.snapshot, "",
                             "expected a time within the session for --snapshot-at, found " +
                                 std::to_string(options_.snapshot_at_s)};
        }
        return error_;
    }

  private:
    const RunOptions& options_;
    const SnapshotAssets& assets_;
    bool taken_ = false;
    std::optional<FileError> error_;
};

// Puts the saved state, if the run is to begin with one, in the place of the scene's first one. The
// players stay who they are. Climbers remember their plans themselves: with them nothing is saved.
std::optional<FileError> resume(const RunOptions& options, const RunSettings& settings,
                                const SnapshotAssets& assets, Scene& scene,
                                std::vector<PlayerEntities>& players) {
    const bool has_climbers = settings.climbers_from < players.size();
    if (has_climbers && !(options.snapshot.empty() && options.resume.empty())) {
        return FileError{options.scene, "",
                         "expected no scripted climbers with --snapshot and --resume, found " +
                             std::to_string(players.size() - settings.climbers_from)};
    }
    if (options.resume.empty()) {
        return std::nullopt;
    }
    const World before = scene.world;
    if (std::optional<FileError> error = load_snapshot_file(options.resume, assets, scene.world)) {
        return error;
    }
    bool all_there = scene.world.player.size() == players.size();
    const auto find_again = [&](Entity& entity) {
        entity = find_by_id(scene.world, before.persistent_id.at(entity));
        all_there = all_there && !is_null(entity);
    };
    for (PlayerEntities& player : players) {
        find_again(player.player);
        for (Entity& hand : player.hands) {
            find_again(hand);
        }
    }
    if (!all_there) {
        return FileError{options.resume, "",
                         "expected a snapshot with the players of this run, found others"};
    }
    return std::nullopt;
}

std::optional<FileError> write_pictures(const std::filesystem::path& folder,
                                        std::vector<FilmShot> shots, ReportMedia& media) {
    std::error_code ignored;
    std::filesystem::create_directories(folder / "shots", ignored);
    for (FilmShot& shot : shots) {
        const std::string bytes(shot.png.begin(), shot.png.end());
        if (auto error = write_file_atomically(folder / "shots" / (shot.name + ".png"), bytes)) {
            return error;
        }
        media.pictures.push_back({shot.caption, std::move(shot.png)});
    }
    return std::nullopt;
}

std::optional<FileError> write_output(const std::filesystem::path& folder, const RunLog& log,
                                      ReportMedia media, std::vector<FilmShot> shots) {
    if (auto error = write_pictures(folder, std::move(shots), media)) {
        return error;
    }
    if (auto error = write_frames_csv(folder / "frames.csv", log)) {
        return error;
    }
    if (auto error = write_bodies_csv(folder / "bodies.csv", log)) {
        return error;
    }
    if (auto error = write_report_json(folder / "report.json", log)) {
        return error;
    }
    return write_report_html(folder / "report.html", log, media);
}

void print_summary(const RunLog& log, const RunSummary& summary) {
    std::printf("%s: %llu frames at %g Hz, %.2f s simulated, %.0f frames a second\n",
                log.scene.c_str(), static_cast<unsigned long long>(summary.frames), log.hz,
                summary.duration_s, summary.frames_per_s);
    std::printf("grabs: %llu onsets, %llu gripped; path of the origin %.2f m\n",
                static_cast<unsigned long long>(summary.totals.grab_onsets),
                static_cast<unsigned long long>(summary.totals.grabs_gripped),
                summary.players.empty() ? 0.0 : summary.players[0].path_m);
    std::printf(
        "hand error, one hand free of contact: %.6f mm; two hands: %.3f mm; worst overlap: %.6f "
        "mm\n",
        summary.hand_error.one_hand_free_m * 1e3, summary.hand_error.two_hands_m * 1e3,
        summary.residual_m * 1e3);
    std::printf("frame: median %.1f us, p99 %.1f us\n", summary.frame.median_us,
                summary.frame.p99_us);
    if (log.player_names.size() > 1) {
        std::printf("%zu players, %zu bytes of state each\n", log.player_names.size(),
                    log.bytes_per_player);
    }
}

// Climbers need jets to come back from where nothing is in reach: who has none gets small ones.
RunSettings choose_settings(const RunOptions& options, Scene& scene, std::size_t players) {
    RunSettings settings{options.hz, options.seconds, options.threads};
    settings.climbers_from = options.climbers ? 0 : 1;
    settings.seed = options.seed;
    settings.keep_frames = !options.out.empty();
    if (options.distance_grab) {
        scene.tuning.pull.reach_m = k_pull_reach_m;
    }
    double& jets_mps2 = scene.tuning.locomotion.thruster_mps2;
    if (players > settings.climbers_from && jets_mps2 == 0.0) {
        jets_mps2 = k_jets_mps2;
    }
    return settings;
}

struct Film {
    std::unique_ptr<SessionFilm> camera;
    ReportMedia media;
};

Film open_film(const RunOptions& options, const Scene& scene, PlayerModels models,
               double session_s) {
    Film film;
    if (options.out.empty() || !options.pictures) {
        return film;
    }
    FilmSettings settings;
    settings.video = std::filesystem::path(options.out) / "run.mp4";
    settings.models = std::move(models);
    std::string why_not;
    film.camera = SessionFilm::open(scene, session_s, settings, why_not);
    if (film.camera == nullptr) {
        std::printf("no pictures: %s\n", why_not.c_str());
    }
    return film;
}

// The shots; the video is on disk then.
std::vector<FilmShot> finish_film(Film& film) {
    if (film.camera == nullptr) {
        return {};
    }
    std::string why_not;
    std::vector<FilmShot> shots = film.camera->finish(why_not);
    if (why_not.empty()) {
        film.media.video = "run.mp4";
    } else {
        std::printf("no video: %s\n", why_not.c_str());
    }
    return shots;
}

RunLog play(Scene& scene, FrameCaches& caches, const std::vector<PlayerEntities>& players,
            const Recording* recording, const RunSettings& settings, SessionFilm* camera,
            RunTally& tally, SnapshotTaker& snapshots) {
    Progress progress("playing " + scene.name);
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
    Result<Scene> loaded = load_scene(options.scene);
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
    const Result<Session> session = load_session(options, scene);
    if (!session) {
        return refuse(session.error());
    }
    if (!options.out.empty()) {
        std::error_code failure;
        std::filesystem::create_directories(options.out, failure);
        if (failure) {
            return refuse(
                {options.out, "", "expected a folder that can be made: " + failure.message()});
        }
    }
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    caches.body_clips = game_body_clips();
    const Result<Place> place = choose_place(options, scene, caches, session.value());
    if (!place) {
        return refuse(place.error());
    }
    Result<std::vector<PlayerEntities>> players =
        add_players(scene, caches, place.value(), options);
    if (!players) {
        return refuse(players.error());
    }
    if (const auto joints = models.value().controller_joints()) {
        set_controller_joints(*joints, scene.world);
    }
    const SnapshotAssets assets(*scene.shapes, scene.name);
    const RunSettings settings = choose_settings(options, scene, players.value().size());
    if (const auto error = resume(options, settings, assets, scene, players.value())) {
        return refuse(*error);
    }

    const Recording* const recording =
        session.value().recording ? &*session.value().recording : nullptr;
    if (!options.shots.empty()) {
        return draw_shots(options, {scene, caches, players.value(), recording, settings},
                          std::move(models.value()));
    }
    Film film =
        open_film(options, scene, std::move(models.value()), session_length_s(recording, settings));
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
        if (!write_trace(options.trace)) {
            return refuse({options.trace, "", "expected a file that can be written"});
        }
    }
    if (!options.out.empty()) {
        std::vector<FilmShot> shots = finish_film(film);
        if (auto error = write_output(options.out, log, std::move(film.media), std::move(shots))) {
            return refuse(*error);
        }
    }
    print_summary(log, tally.finish(log));
    std::printf("state_hash %s\n", format_hash(log.state_hash).c_str());
    return 0;
}

}  // namespace handhold
