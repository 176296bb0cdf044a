#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/result.hpp"
#include "game/commands/run_command.hpp"
#include "game/report/report_html.hpp"
#include "game/report/run_summary.hpp"
#include "game/run/run_log.hpp"
#include "game/scene/scene.hpp"
#include "game/view/film.hpp"
#include "game/view/player_models.hpp"

// What `handhold run` leaves: the film of the session, the files of --out, and the printed summary.
namespace handhold {

// The film of a run; `camera` is null if nothing is filmed.
struct RunFilm {
    std::filesystem::path folder;
    std::unique_ptr<SessionFilm> camera;
    ReportMedia media;
    std::size_t written = 0;         // pictures in `folder`
    std::optional<FileError> error;  // error of the first picture that could not be written
};

// Prints why there are no pictures if they cannot be drawn.
RunFilm open_run_film(const RunOptions& options, const Scene& scene, PlayerModels models,
                      double session_s);

// Call after each frame. Pictures are written as soon as they are drawn.
void film_frame(const FrameLog& frame, RunFilm& film);

// Finishes the video, and writes tables and reports into `folder`.
std::optional<FileError> write_run_output(const std::filesystem::path& folder, const RunLog& log,
                                          RunFilm& film);

// Prints the summary to standard output, except for its last line.
void print_run_summary(const RunLog& log, const RunSummary& summary);

}  // namespace handhold
