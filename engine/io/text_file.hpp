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

// Writes a temporary file beside `path` and renames it, so that a reader sees either the old or the
// new bytes. The folder must exist. After a failure, returns the reason; `path` is unchanged and no
// temporary file remains.
[[nodiscard]] std::optional<FileError> write_file_atomically(const std::filesystem::path& path,
                                                             std::string_view text);

}  // namespace handhold
