#pragma once

#include <filesystem>

#include "engine/core/result.hpp"

namespace handhold {

// Exclusive access to an output folder. The operating system holds the lock: it ends with the
// process and leaves no file. A folder on a file system without locks is not locked.
class OutputFolder {
  public:
    // Creates the folder and its parents if needed. Fails if the path is not a folder, or if
    // another OutputFolder has locked it.
    static Result<OutputFolder> open(const std::filesystem::path& path);
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&& other) = delete;
    ~OutputFolder();

  private:
    explicit OutputFolder(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;  // the folder's file descriptor; -1: moved from
};

}  // namespace handhold
