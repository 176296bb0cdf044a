#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace handhold {

// Limit of a file that is read into memory. No file that Handhold reads is meant to be larger.
constexpr std::uint64_t k_max_file_bytes = 1ULL << 30;

// Reads all bytes of a file. Errors: a file that is absent, unreadable, not regular (a folder, a
// pipe, a device) or larger than `max_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uint64_t max_bytes = k_max_file_bytes);

// The file that a rename onto `path` may replace: `path`, or the file at the end of its links.
// Errors: a folder, a device, a pipe, a socket, a link to nothing.
Result<std::filesystem::path> replaceable_file(const std::filesystem::path& path);

// Writes a temporary file beside replaceable_file(path) and renames it, so a reader sees either the
// old bytes or the new ones. The folder must exist. A character device (/dev/null) is written to
// directly. Returns the reason for a failure. A failure leaves `path` unchanged and no temporary
// file.
[[nodiscard]] std::optional<FileError> write_file_atomically(const std::filesystem::path& path,
                                                             std::string_view text);

}  // namespace handhold
