#include "game/commands/output_folder.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace handhold {

Result<OutputFolder> OutputFolder::open(const std::filesystem::path& path) {
    const auto refused = [&](const std::string& expected) {
        return FileError{path.string(), "", expected};
    };
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure) {
        return refused("expected a folder that can be made: " + failure.message());
    }
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return refused("expected a folder: " + std::generic_category().message(errno));
    }
    OutputFolder folder(descriptor);
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        return refused("expected a folder that nothing else writes into, found one in use");
    }
    return folder;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFolder::~OutputFolder() {
    if (descriptor_ >= 0) {
        close(descriptor_);  // releases the lock
    }
}

}  // namespace handhold
