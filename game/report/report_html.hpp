#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/result.hpp"
#include "game/session/run_log.hpp"

// report.html: a run for people, on one page that needs no other file (but the video), no network
// and no scripts.
namespace handhold {

struct ReportPicture {
    std::string caption;
    std::vector<std::uint8_t> png;  // a whole PNG file: encode_png
};

struct ReportMedia {
    std::vector<ReportPicture> pictures;  // in the order of the page; become part of it
    std::string video;                    // path relative to the page, "run.mp4"; empty: none
};

// Preconditions: those of summarize_run.
std::string format_report_html(const RunLog& log, const ReportMedia& media = {});

// The same into a file. Returns the reason where it cannot be written.
[[nodiscard]] std::optional<FileError> write_report_html(const std::filesystem::path& path,
                                                         const RunLog& log,
                                                         const ReportMedia& media = {});

}  // namespace handhold
