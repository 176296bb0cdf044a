#include "game/commands/run_output.hpp"

#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "engine/core/printable.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/file_name.hpp"
#include "game/report/frames_csv.hpp"
#include "game/report/report_json.hpp"

namespace handhold {
namespace {

std::optional<FileError> write_picture(const std::filesystem::path& folder, const FilmShot& shot) {
    std::error_code failure;
    std::filesystem::create_directories(folder / "shots", failure);
    if (failure) {
        return FileError{(folder / "shots").string(), "",
                         "expected a folder that can be made: " + failure.message()};
    }
    return write_file_atomically(folder / "shots" / (file_name(shot.name) + ".png"),
                                 std::string(shot.png.begin(), shot.png.end()));
}

// Finishes the video, and moves the pictures into the report's media.
void finish_film(RunFilm& film) {
    if (film.camera == nullptr) {
        return;
    }
    std::string why_not;
    for (FilmShot& shot : film.camera->finish(why_not)) {
        film.media.pictures.push_back({std::move(shot.caption), std::move(shot.png)});
    }
    if (why_not.empty()) {
        film.media.video = "run.mp4";
    } else {
        std::printf("no video: %s\n", why_not.c_str());
    }
}

}  // namespace

RunFilm open_run_film(const RunOptions& options, const Scene& scene, PlayerModels models,
                      double session_s) {
    RunFilm film;
    if (options.out.empty() || !options.pictures) {
        return film;
    }
    film.folder = options.out;
    FilmSettings settings;
    settings.video = film.folder / "run.mp4";
    settings.models = std::move(models);
    std::string why_not;
    film.camera = SessionFilm::open(scene, session_s, settings, why_not);
    if (film.camera == nullptr) {
        std::printf("no pictures: %s\n", why_not.c_str());
    }
    return film;
}

void film_frame(const FrameLog& frame, RunFilm& film) {
    if (film.camera == nullptr) {
        return;
    }
    film.camera->watch(frame);
    const std::vector<FilmShot>& shots = film.camera->shots();
    for (; film.written < shots.size() && !film.error; ++film.written) {
        film.error = write_picture(film.folder, shots[film.written]);
    }
}

std::optional<FileError> write_run_output(const std::filesystem::path& folder, const RunLog& log,
                                          RunFilm& film) {
    finish_film(film);
    if (film.error) {
        return film.error;
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
    return write_report_html(folder / "report.html", log, film.media);
}

void print_run_summary(const RunLog& log, const RunSummary& summary) {
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

}  // namespace handhold
