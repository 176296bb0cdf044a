#include "game/commands/run_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/core/profile.hpp"
#include "engine/io/file_name.hpp"
#include "engine/io/printable.hpp"
#include "engine/io/text_file.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/climber/crowd.hpp"
#include "game/commands/exit_status.hpp"
#include "game/commands/loading.hpp"
#include "game/commands/output_folder.hpp"
#include "game/commands/progress.hpp"
#include "game/render/image.hpp"
#include "game/report/frames_csv.hpp"
#include "game/report/report_html.hpp"
#include "game/report/report_json.hpp"
#include "game/report/run_summary.hpp"
#include "game/scene/built_in_scenes.hpp"
#include "game/scene/overlaps.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/scene/spawn.hpp"
#include "game/session/interrupt.hpp"
#include "game/session/session_run.hpp"
#include "game/view/film.hpp"
#include "game/view/run_shots.hpp"
#include "systems/snapshot.hpp"

namespace handhold {
namespace {

struct Session {
    std::optional<Recording> recording;
    std::vector<Recording> more;  // recordings of the second player, the third, ...
    std::string name;             // names of the files, "built-in <name>", or empty: no session
};

// Loads the players' recordings: those of --input, else the scene's session, else none.
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
    for (const std::string& input : options.more_inputs) {
        Result<Recording> another = load_recording(input);
        if (!another) {
            return another.error();
        }
        session.more.push_back(std::move(another.value()));
        session.name += ", " + std::filesystem::path(input).filename().string();
    }
    return session;
}

// Limits the session's length. Times in a recording are arbitrary: two samples may be years apart.
std::optional<FileError> check_length(const RunOptions& options, const std::string& name,
                                      double length_s) {
    constexpr double k_longest_s = 1e6;  // the limit of --seconds
    if (length_s <= k_longest_s) {
        return std::nullopt;
    }
    return FileError{options.input.empty() ? name : options.input, "",
                     "expected a session of at most 1e6 s, or --seconds, found one of " +
                         std::to_string(length_s) + " s"};
}

struct Place {
    Pose origin_ws;
    std::string name;
};

// `spawn`: see RunOptions::spawn.
Result<Place> choose_place(const RunOptions& options, const std::string& spawn, const Scene& scene,
                           FrameCaches& caches, const Recording* recording) {
    if (spawn == "auto") {
        if (recording == nullptr) {
            return FileError{options.scene, "", "expected a session for --spawn auto, found none"};
        }
        const FoundSpawn found = find_spawn(scene, caches, *recording, options.hz);
        const Vec3& at = found.origin_ws.position;
        std::printf("spawn auto: %.3f %.3f %.3f, %zu of %zu grabs grip when tried\n", at.x(),
                    at.y(), at.z(), found.gripped, found.onsets);
        return Place{found.origin_ws, "auto"};
    }
    for (const SceneSpawnPoint& known : scene.spawns) {
        if (spawn.empty() || known.name == spawn) {
            return Place{known.pose_ws, known.name};
        }
    }
    if (!spawn.empty()) {
        constexpr std::size_t k_listed = 5;
        std::string names;
        for (std::size_t i = 0; i < std::min(k_listed, scene.spawns.size()); ++i) {
            names += printable(scene.spawns[i].name, k_max_shown_name / 2) + ", ";
        }
        return FileError{options.scene, "/spawns",
                         "expected " + names +
                             (scene.spawns.size() > k_listed ? "another spawn, " : "") +
                             "or auto, found \"" + spawn + "\""};
    }
    return Place{{}, "origin"};
}

std::size_t recorded_players(const RunOptions& options) { return 1 + options.more_inputs.size(); }

// Start places of players with recordings: `first`, then those of --spawn, then the scene's next
// spawns. Returns fewer places than recordings if the scene has no more spawns.
Result<std::vector<Place>> choose_places(const RunOptions& options, const Place& first,
                                         const Scene& scene, FrameCaches& caches,
                                         const Session& session) {
    std::vector<Place> places = {first};
    for (std::size_t i = 1; i < recorded_players(options); ++i) {
        if (i - 1 < options.more_spawns.size()) {
            Result<Place> place = choose_place(options, options.more_spawns[i - 1], scene, caches,
                                               &session.more[i - 1]);
            if (!place) {
                return place.error();
            }
            places.push_back(std::move(place.value()));
        } else if (options.spawn.empty() && i < scene.spawns.size()) {
            places.push_back({scene.spawns[i].pose_ws, scene.spawns[i].name});
        } else {
            break;
        }
    }
    return places;
}

// Adds the scene's own players if there are enough of them and neither --spawn nor --players was
// given. Otherwise adds the first players at `places` and spreads the others over the scene.
Result<std::vector<PlayerEntities>> add_players(Scene& scene, FrameCaches& caches,
                                                const std::vector<Place>& places,
                                                const RunOptions& options) {
    std::vector<ScenePlayerStart> starts;
    if (scene.players.size() >= recorded_players(options) && options.spawn.empty() &&
        options.players == 0) {
        starts = scene.players;
    } else {
        const auto count =
            options.players > 0
                ? static_cast<std::size_t>(options.players)
                : std::max(recorded_players(options), static_cast<std::size_t>(1 + scene.climbers));
        for (const Pose& origin_ws :
             spread_players(scene, caches, places.front().origin_ws, count, options.seed)) {
            const std::size_t i = starts.size();
            const std::string name = "player" + std::to_string(i);
            starts.push_back({free_player_name(scene.world, name),
                              i < places.size() ? places[i].origin_ws : origin_ws, 80.0});
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

void warn_of_overlaps(const Scene& scene, FrameCaches& caches,
                      const std::vector<PlayerEntities>& players) {
    constexpr std::size_t k_told = 5;
    const std::vector<SpawnOverlap> overlaps = find_overlaps(scene, caches, players);
    for (std::size_t i = 0; i < std::min(k_told, overlaps.size()); ++i) {
        std::fprintf(stderr, "warning: %s and %s begin %.0f mm inside each other\n",
                     printable(overlaps[i].a, k_max_shown_name).c_str(),
                     printable(overlaps[i].b, k_max_shown_name).c_str(), 1e3 * overlaps[i].depth_m);
    }
    if (overlaps.size() > k_told) {
        std::fprintf(stderr, "warning: %zu more pairs begin inside each other\n",
                     overlaps.size() - k_told);
    }
}

// Saves the snapshot of --snapshot once its time is reached.
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
    // Call after the session. The snapshot's error, or nullopt.
    std::optional<FileError> error() const {
        if (!options_.snapshot.empty() && !taken_ && !is_interrupted()) {
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

// Replaces the scene's initial state by the snapshot of --resume, if given. Players keep their
// persistent ids. Fails if there are climbers, because a snapshot does not contain their plans.
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
    std::error_code failure;
    std::filesystem::create_directories(folder / "shots", failure);
    if (failure) {
        return FileError{(folder / "shots").string(), "",
                         "expected a folder that can be made: " + failure.message()};
    }
    for (FilmShot& shot : shots) {
        const std::string bytes(shot.png.begin(), shot.png.end());
        if (auto error =
                write_file_atomically(folder / "shots" / (file_name(shot.name) + ".png"), bytes)) {
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
                printable(log.scene).c_str(), static_cast<unsigned long long>(summary.frames),
                log.hz, summary.duration_s, summary.frames_per_s);
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

// Finishes the video and returns the pictures.
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
    const Result<Session> session = load_session(options, scene);
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
    const Result<Place> place = choose_place(options, options.spawn, scene, caches, recording);
    if (!place) {
        return refuse(place.error());
    }
    const Result<std::vector<Place>> places =
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
    if (const auto error = resume(options, settings, assets, scene, players.value())) {
        return refuse(*error);
    }

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
        if (const auto error = write_trace(options.trace)) {
            return refuse(*error);
        }
    }
    if (!options.out.empty()) {
        std::vector<FilmShot> shots = finish_film(film);
        if (auto error = write_output(options.out, log, std::move(film.media), std::move(shots))) {
            return refuse(*error);
        }
    }
    print_summary(log, tally.finish(log));
    if (is_interrupted()) {
        std::printf("interrupted: the files are of the frames played so far\n");
    }
    std::printf("state_hash %s\n", format_hash(log.state_hash).c_str());
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace handhold
