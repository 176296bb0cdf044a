#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/io/result.hpp"
#include "game/session/run_log.hpp"

// report.json: the figures of a run (run_summary.hpp) for scripts; keys are added, never renamed or
// dropped.
namespace handhold {

// Numbers come back bit for bit; one that is not finite is null. Names that are not UTF-8 are
// written with replacement characters. Preconditions: those of summarize_run.
std::string format_report_json(const RunLog& log);

// The same into a file. Returns the reason where it cannot be written.
[[nodiscard]] std::optional<FileError> write_report_json(const std::filesystem::path& path,
                                                         const RunLog& log);

}  // namespace handhold
