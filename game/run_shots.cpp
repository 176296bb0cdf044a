#include "game/run_shots.hpp"

#include <cstdio>
#include <utility>

#include "game/exit_status.hpp"
#include "game/shot_film.hpp"

namespace handhold {
namespace {

// Those of the scene; a list that asks for none of it is refused.
Result<std::vector<Shot>> choose_shots(const RunOptions& options) {
    Result<std::vector<Shot>> shots = load_shots(options.shots);
    if (!shots) {
        return shots.error();
    }
    std::erase_if(shots.value(), [&](const Shot& shot) { return shot.scene != options.scene; });
    if (shots.value().empty() || options.out.empty()) {
        return FileError{options.shots, "/shots",
                         "expected --out and shots of the scene \"" + options.scene + "\""};
    }
    return shots;
}

}  // namespace

int draw_shots(const RunOptions& options, ReadySession session, PlayerModels models) {
    Result<std::vector<Shot>> shots = choose_shots(options);
    if (!shots) {
        return refuse(shots.error());
    }
    ShotFilmSettings drawn;
    drawn.width_px = options.shot_width_px;
    drawn.height_px = options.shot_height_px;
    drawn.quality = options.shot_quality;
    drawn.out = options.out;
    drawn.models = std::move(models);
    std::string why_not;
    const auto film =
        ShotFilm::open(session.scene, session.caches, std::move(shots.value()), drawn, why_not);
    if (film == nullptr) {
        std::fprintf(stderr, "no pictures: %s\n", why_not.c_str());
        return k_exit_bad_file;
    }
    constexpr double k_after_s = 0.1;
    session.settings.seconds = film->length_s() + k_after_s;
    session.settings.keep_frames = false;
    run_session(session.scene, session.caches, session.players, session.recording, session.settings,
                [&](const Scene&, const FrameLog& frame) { film->watch(frame.t_s); });
    const std::size_t saved = film->finish(why_not);
    std::printf("%s: %zu shots\n", session.scene.name.c_str(), saved);
    if (!why_not.empty()) {
        std::fprintf(stderr, "%s\n", why_not.c_str());
    }
    return why_not.empty() ? 0 : k_exit_bad_file;
}

}  // namespace handhold
