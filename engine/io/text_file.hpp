#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/io/result.hpp"

namespace handhold {

// Limit of a file that is read into memory. A larger file is not one of ours.
constexpr std::uint64_t k_max_file_bytes = 1ULL << 30;

// The unchanged bytes of a file. Refuses a file that is absent, unreadable, not regular (a folder,
// a pipe, a device) or larger than `max_bytes`.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uint64_t max_bytes = k_max_file_bytes);

// The file that a rename onto `path` may replace: `path`, or the file at the end of its links.
// Refused: a folder, a device, a pipe, a socket, a link to nothing.
Result<std::filesystem::path> replaceable_file(const std::filesystem::path& path);

// Writes a temporary file beside replaceable_file(path) and renames it: a reader sees the old bytes
// or the new ones, never a part. The folder must exist. A character device (/dev/null) is written
// to directly. Returns the reason for a failure, which leaves `path` as it was and no temporary
// file.
[[nodiscard]] std::optional<FileError> write_file_atomically(const std::filesystem::path& path,
                                                             std::string_view text);

}  // namespace handhold
