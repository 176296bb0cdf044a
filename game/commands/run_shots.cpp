#include "game/commands/run_shots.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/printable.hpp"
#include "game/commands/shot_film.hpp"
#include "game/play/exit_status.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {
namespace {

// Loads the scene's shots; fails if the list has none.
Result<std::vector<Shot>> choose_shots(const RunOptions& options, const std::string& scene) {
    Result<std::vector<Shot>> shots = load_shots(options.shots);
    if (!shots) {
        return shots.error();
    }
    std::erase_if(shots.value(), [&](const Shot& shot) { return shot.scene != scene; });
    if (shots.value().empty()) {
        return FileError{options.shots, "/shots", "expected shots of the scene \"" + scene + "\""};
    }
    return shots;
}

// An error for the first shot that names a body or player that the scene does not have.
std::optional<FileError> check_names(const RunOptions& options, const std::vector<Shot>& shots,
                                     const World& world) {
    for (const Shot& shot : shots) {
        const Entity named = find_by_id(world, persistent_id_from_name(shot.body));
        const bool is_there = shot.view == ShotView::body     ? world.body_pose.contains(named)
                              : shot.view == ShotView::player ? world.render_pose.contains(named)
                                                              : true;
        if (!is_there) {
            return FileError{options.shots, "/shots/" + std::to_string(shot.number) + "/body",
                             "expected a name in the scene, found \"" + shot.body + "\""};
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<ShotFilm>> open_shots(const RunOptions& options,
                                             const std::string& scene_name, const Scene& scene,
                                             PlayerModels models) {
    Result<std::vector<Shot>> shots = choose_shots(options, scene_name);
    if (!shots) {
        return shots.error();
    }
    if (const auto error = check_names(options, shots.value(), scene.world())) {
        return *error;
    }
    ShotFilmSettings drawn;
    drawn.width_px = options.shot_width_px;
    drawn.height_px = options.shot_height_px;
    drawn.quality = options.shot_quality;
    drawn.out = options.out;
    drawn.models = std::move(models);
    std::string why_not;
    std::unique_ptr<ShotFilm> film =
        ShotFilm::open(scene, std::move(shots.value()), drawn, why_not);
    if (film == nullptr) {
        return FileError{options.out, "", "no pictures: " + why_not};
    }
    return film;
}

int draw_shots(const RunOptions& options, ReadySession session, PlayerModels models) {
    const auto opened = open_shots(options, options.scene, session.scene, std::move(models));
    if (!opened) {
        return refuse(opened.error());
    }
    const std::unique_ptr<ShotFilm>& film = opened.value();
    constexpr double k_after_s = 0.1;
    session.settings.seconds = film->length_s() + k_after_s;
    session.settings.keep_frames = false;
    run_session(session.scene, player_ids(session.players), session.recording, session.settings,
                [&](const Scene&, const FrameLog& frame) { film->watch(frame.t_s); });
    return finish_shots(session.scene.name, *film);
}

int finish_shots(const std::string& scene, ShotFilm& film) {
    std::string why_not;
    const std::size_t saved = film.finish(why_not);
    std::printf("%s: %zu shots\n", printable(scene).c_str(), saved);
    if (is_interrupted()) {
        return k_exit_interrupted;
    }
    if (!why_not.empty()) {
        std::fprintf(stderr, "%s\n", printable(why_not, 3 * k_max_quoted).c_str());
    }
    return why_not.empty() ? 0 : k_exit_bad_file;
}

}  // namespace handhold
