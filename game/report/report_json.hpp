#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/core/result.hpp"
#include "game/run/run_log.hpp"

// report.json: the figures of a run (run_summary.hpp) for scripts. Releases may add keys but never
// rename or drop them.
namespace handhold {

// The text of report.json. Numbers round-trip exactly; numbers that are not finite become null.
// Invalid UTF-8 in names is replaced. Preconditions: those of summarize_run.
std::string format_report_json(const RunLog& log);

// Writes format_report_json to a file. Returns the reason for a failure.
[[nodiscard]] std::optional<FileError> write_report_json(const std::filesystem::path& path,
                                                         const RunLog& log);

}  // namespace handhold
