#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/core/result.hpp"
#include "game/run/run_log.hpp"

// Tables of a run: one line for each frame and player, or for each frame and body. SI units unless
// a column's name says otherwise; numbers round-trip exactly. Stage times are left out, so equal
// runs give equal files. Preconditions: indices of players and bodies are valid in RunLog's lists
// of names, and body_mass_kg is as long as body_names.
namespace handhold {

// frames.csv. The columns up to `contacts`, with their names and order, are a contract with
// external scripts; more columns follow. `player` is an index in RunLog::player_names. `l_body` and
// `r_body` are names, empty for none. residual_mm and all later columns except the velocity belong
// to the frame and are repeated for each player.
std::string format_frames_csv(const RunLog& log);
// bodies.csv: kinematic and free bodies at the end of each frame; mass_kg is 0 for kinematic
// bodies.
std::string format_bodies_csv(const RunLog& log);

// Writes format_frames_csv or format_bodies_csv to a file. Returns the reason for a failure.
[[nodiscard]] std::optional<FileError> write_frames_csv(const std::filesystem::path& path,
                                                        const RunLog& log);
[[nodiscard]] std::optional<FileError> write_bodies_csv(const std::filesystem::path& path,
                                                        const RunLog& log);

}  // namespace handhold
