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
Result<std::vector<Shot>> choose_shots(const RunOptions& options) {
    Result<std::vector<Shot>> shots = load_shots(options.shots);
    if (!shots) {
        return shots.error();
    }
    std::erase_if(shots.value(), [&](const Shot& shot) { return shot.scene != options.scene; });
    if (shots.value().empty()) {
        return FileError{options.shots, "/shots",
                         "expected shots of the scene \"" + options.scene + "\""};
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

int draw_shots(const RunOptions& options, ReadySession session, PlayerModels models) {
    Result<std::vector<Shot>> shots = choose_shots(options);
    if (!shots) {
        return refuse(shots.error());
    }
    if (const auto error = check_names(options, shots.value(), session.scene.world())) {
        return refuse(*error);
    }
    ShotFilmSettings drawn;
    drawn.width_px = options.shot_width_px;
    drawn.height_px = options.shot_height_px;
    drawn.quality = options.shot_quality;
    drawn.out = options.out;
    drawn.models = std::move(models);
    std::string why_not;
    const auto film = ShotFilm::open(session.scene, std::move(shots.value()), drawn, why_not);
    if (film == nullptr) {
        std::fprintf(stderr, "no pictures: %s\n", why_not.c_str());
        return k_exit_bad_file;
    }
    constexpr double k_after_s = 0.1;
    session.settings.seconds = film->length_s() + k_after_s;
    session.settings.keep_frames = false;
    run_session(session.scene, player_ids(session.players), session.recording, session.settings,
                [&](const Scene&, const FrameLog& frame) { film->watch(frame.t_s); });
    const std::size_t saved = film->finish(why_not);
    std::printf("%s: %zu shots\n", printable(session.scene.name).c_str(), saved);
    if (is_interrupted()) {
        return k_exit_interrupted;
    }
    if (!why_not.empty()) {
        std::fprintf(stderr, "%s\n", printable(why_not, 3 * k_max_quoted).c_str());
    }
    return why_not.empty() ? 0 : k_exit_bad_file;
}

}  // namespace handhold
