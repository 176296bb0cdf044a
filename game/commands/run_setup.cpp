#include "game/commands/run_setup.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "engine/core/printable.hpp"
#include "game/climber/crowd.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/run/spawn.hpp"
#include "game/scene/overlaps.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {

Result<RunSession> load_session(const RunOptions& options, const Scene& scene) {
    RunSession session;
    std::filesystem::path file = options.input;
    if (file.empty() && scene.session) {
        if (!scene.session->built_in.empty()) {
            session.recording = make_built_in_session(scene.session->built_in);
            if (!session.recording) {
                return FileError{options.scene, "/session",
                                 "expected the name of a built-in session, found \"" +
                                     scene.session->built_in + "\""};
            }
            session.more = make_built_in_partners(scene.session->built_in);
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

std::optional<FileError> check_length(const RunOptions& options, const std::string& name,
                                      double length_s) {
    constexpr double k_longest_s = 1e6;  // limit of --seconds
    if (length_s <= k_longest_s) {
        return std::nullopt;
    }
    return FileError{options.input.empty() ? name : options.input, "",
                     "expected a session of at most 1e6 s, or --seconds, found one of " +
                         std::to_string(length_s) + " s"};
}

Result<StartPlace> choose_place(const RunOptions& options, const std::string& spawn, Scene& scene,
                                const Recording* recording) {
    if (spawn == "auto") {
        if (recording == nullptr) {
            return FileError{options.scene, "", "expected a session for --spawn auto, found none"};
        }
        const FoundSpawn found = find_spawn(scene, *recording, options.hz);
        const hh::Vec3& at = found.origin_ws.position;
        std::printf("spawn auto: %.3f %.3f %.3f, %zu of %zu grabs grip when tried\n", at.x, at.y,
                    at.z, found.gripped, found.onsets);
        return StartPlace{found.origin_ws, "auto"};
    }
    for (const SceneSpawnPoint& known : scene.spawns) {
        if (spawn.empty() || known.name == spawn) {
            return StartPlace{known.pose_ws, known.name};
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
    return StartPlace{hh::k_origin, "origin"};
}

std::size_t recorded_players(const RunSession& session) { return 1 + session.more.size(); }

Result<std::vector<StartPlace>> choose_places(const RunOptions& options, const StartPlace& first,
                                              Scene& scene, const RunSession& session) {
    std::vector<StartPlace> places = {first};
    for (std::size_t i = 1; i < recorded_players(session); ++i) {
        if (i - 1 < options.more_spawns.size()) {
            Result<StartPlace> place =
                choose_place(options, options.more_spawns[i - 1], scene, &session.more[i - 1]);
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

Result<std::vector<PlayerEntities>> add_players(Scene& scene, const std::vector<StartPlace>& places,
                                                const RunOptions& options,
                                                const RunSession& session) {
    std::vector<ScenePlayerStart> starts;
    if (scene.players.size() >= recorded_players(session) && options.spawn.empty() &&
        options.players == 0) {
        starts = scene.players;
    } else if (scene.arena && options.spawn.empty() && options.players == 0 && !session.recording) {
        for (std::size_t i = 0; i < scene.spawns.size(); ++i) {
            starts.push_back({"player" + std::to_string(i), from_host(scene.spawns[i].pose_ws)});
        }
    } else {
        const auto count =
            options.players > 0
                ? static_cast<std::size_t>(options.players)
                : std::max(recorded_players(session), static_cast<std::size_t>(1 + scene.climbers));
        for (const hh::Pose& origin_ws :
             spread_players(scene, places.front().origin_ws, count, options.seed)) {
            const std::size_t i = starts.size();
            const std::string name = "player" + std::to_string(i);
            starts.push_back({free_player_name(scene.world(), name),
                              from_host(i < places.size() ? places[i].origin_ws : origin_ws),
                              80.0});
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

RunSettings choose_settings(const RunOptions& options, const RunSession& session,
                            std::size_t players, Scene& scene) {
    RunSettings settings{options.hz, options.seconds, options.threads};
    const bool bots_only = options.climbers || (scene.arena && !session.recording);
    settings.climbers_from = bots_only ? 0 : recorded_players(session);
    constexpr double k_arena_s = 40.0;
    if (scene.arena && !session.recording && settings.seconds == 0.0) {
        settings.seconds = k_arena_s;
    }
    settings.seed = options.seed;
    settings.keep_frames = !options.out.empty();
    if (options.distance_grab) {
        scene.tuning().pull.reach_m = k_pull_reach_m;
    }
    double& jets_mps2 = scene.tuning().locomotion.thruster_mps2;
    if (players > settings.climbers_from && jets_mps2 == 0.0) {
        jets_mps2 = k_jets_mps2;
    }
    return settings;
}

void warn_of_overlaps(Scene& scene, const std::vector<PlayerEntities>& players) {
    constexpr std::size_t k_told = 5;
    const std::vector<SpawnOverlap> overlaps = find_overlaps(scene, players);
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

}  // namespace handhold
