#pragma once

#include <filesystem>

#include "engine/io/result.hpp"

namespace handhold {

// Exclusive access to a folder for output. The lock is the operating system's: it ends with the
// process and leaves no file.
class OutputFolder {
  public:
    // Makes the folder and its parents if needed. Refused: a path that is not a folder, and a
    // folder that another OutputFolder holds.
    static Result<OutputFolder> open(const std::filesystem::path& path);
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&& other) = delete;
    ~OutputFolder();

  private:
    explicit OutputFolder(int descriptor) : descriptor_(descriptor) {}
    int descriptor_ = -1;  // -1: moved from, or a file system without locks
};

}  // namespace handhold
