#include "engine/io/text_file.hpp"

#include <fstream>
#include <random>
#include <system_error>

namespace handhold {

namespace fs = std::filesystem;

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
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
        return refuse("expected a readable file of " + std::to_string(size) + " bytes");
    }
    return bytes;
}

std::optional<FileError> write_file_atomically(const fs::path& path, std::string_view text) {
    // The random suffix keeps two processes that write the same path from sharing a temporary file.
    fs::path temporary = path;
    temporary += ".tmp" + std::to_string(std::random_device()());
    std::error_code error;
    {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream) {
            fs::remove(temporary, error);
            return FileError{path.string(), "", "expected a writable place in an existing folder"};
        }
    }
    fs::rename(temporary, path, error);
    if (error) {
        const std::string reason = error.message();
        fs::remove(temporary, error);
        return FileError{path.string(), "", "expected a file that can be replaced: " + reason};
    }
    return std::nullopt;
}

}  // namespace handhold
