#include "engine/core/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>

namespace handhold {

namespace fs = std::filesystem;

namespace {

// Writes all bytes to a file, opened with fopen's `mode`. Returns the reason for a failure; empty
// if there is none.
std::string write_bytes(const fs::path& path, const char* mode, std::string_view bytes) {
    const auto reason = [] {
        return "expected a writable place in an existing folder: " +
               std::generic_category().message(errno);
    };
    std::FILE* const file = std::fopen(path.string().c_str(), mode);
    if (file == nullptr) {
        return reason();
    }
    std::string failure;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file) < bytes.size() || std::fflush(file) != 0) {
        failure = reason();
    }
    if (std::fclose(file) != 0 && failure.empty()) {
        failure = reason();
    }
    return failure;
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::uint64_t max_bytes) {
    const auto refuse = [&](std::string reason) {
        return FileError{path.string(), "", std::move(reason)};
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) {
        return refuse("expected a readable file, found none");
    }
    if (!fs::is_regular_file(status)) {
        return refuse("expected a regular file, found a folder or a device");
    }
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) {
        return refuse("expected a readable file: " + error.message());
    }
    if (size > max_bytes) {
        return refuse("expected at most " + std::to_string(max_bytes) + " bytes, found " +
                      std::to_string(size));
    }
    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::FILE* const file = std::fopen(path.string().c_str(), "rb");
    const bool is_read =
        file != nullptr && std::fread(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file != nullptr) {
        std::fclose(file);
    }
    if (!is_read) {
        return refuse("expected a readable file of " + std::to_string(size) + " bytes");
    }
    return bytes;
}

Result<fs::path> replaceable_file(const fs::path& path) {
    std::error_code error;
    const fs::file_status own = fs::symlink_status(path, error);
    if (own.type() == fs::file_type::not_found || own.type() == fs::file_type::regular) {
        return path;
    }
    const fs::path target = fs::canonical(path, error);
    if (error) {
        return FileError{path.string(), "", "expected a writable file: " + error.message()};
    }
    if (!fs::is_regular_file(target, error)) {
        return FileError{path.string(), "",
                         "expected a regular file, found a folder, a pipe or a device"};
    }
    return target;
}

std::optional<FileError> write_file_atomically(const fs::path& path, std::string_view text) {
    std::error_code error;
    if (fs::is_character_file(path, error)) {
        const std::string reason = write_bytes(path, "wb", text);
        return reason.empty() ? std::nullopt : std::optional(FileError{path.string(), "", reason});
    }
    const Result<fs::path> target = replaceable_file(path);
    if (!target) {
        return target.error();
    }
    // The random suffix prevents two processes that write to the same path from sharing a temporary
    // file.
    fs::path temporary = target.value();
    temporary += ".tmp" + std::to_string(std::random_device()());
    std::string reason = write_bytes(temporary, "wbx", text);
    if (reason.empty()) {
        const fs::file_status replaced = fs::status(target.value(), error);
        if (fs::exists(replaced)) {
            fs::permissions(temporary, replaced.permissions(), error);
        }
        fs::rename(temporary, target.value(), error);
        if (!error) {
            return std::nullopt;
        }
        reason = "expected a file that can be replaced: " + error.message();
    }
    fs::remove(temporary, error);
    return FileError{path.string(), "", reason};
}

}  // namespace handhold
