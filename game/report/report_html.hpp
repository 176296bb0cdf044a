#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "game/run/run_log.hpp"

// report.html: a run as one page without scripts that needs no other file (except the video) and no
// network.
namespace handhold {

struct ReportPicture {
    std::string caption;
    std::vector<std::uint8_t> png;  // whole PNG file: encode_png
};

struct ReportMedia {
    std::vector<ReportPicture> pictures;  // embedded pictures in the order of the page
    std::string video;                    // path relative to the page, "run.mp4"; empty: none
};

// The text of report.html. Preconditions: those of summarize_run.
std::string format_report_html(const RunLog& log, const ReportMedia& media = {});

// Writes format_report_html to a file. Returns the reason for a failure.
[[nodiscard]] std::optional<FileError> write_report_html(const std::filesystem::path& path,
                                                         const RunLog& log,
                                                         const ReportMedia& media = {});

}  // namespace handhold
