#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/io/result.hpp"
#include "game/session/run_log.hpp"

// A run as tables, one row a frame and player, or a frame and body. SI units except where a
// column's name says otherwise; numbers come back bit for bit. Times of stages are not in here: the
// files of two runs are equal where the runs are. Preconditions: indices of players and bodies lie
// in RunLog's lists of names, and body_mass_kg is as long as body_names.
namespace handhold {

// frames.csv. The columns up to `contacts`, their names and their order are a contract with scripts
// elsewhere; more follow. `player` is the index into RunLog::player_names, `l_body` and `r_body`
// are names, empty for none; residual_mm and all after it are the frame's, the same in the rows of
// all players, except the velocity.
std::string format_frames_csv(const RunLog& log);
// bodies.csv: kinematic and free bodies at the end of each frame; mass_kg is 0 for kinematic ones.
std::string format_bodies_csv(const RunLog& log);

// The same into a file. Returns the reason where it cannot be written.
[[nodiscard]] std::optional<FileError> write_frames_csv(const std::filesystem::path& path,
                                                        const RunLog& log);
[[nodiscard]] std::optional<FileError> write_bodies_csv(const std::filesystem::path& path,
                                                        const RunLog& log);

}  // namespace handhold
