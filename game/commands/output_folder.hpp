#pragma once

#include <filesystem>

#include "engine/io/result.hpp"

namespace handhold {

// A folder that one process at a time writes its files into. The lock is the operating system's: it
// ends with the process, and leaves no file.
class OutputFolder {
  public:
    // Makes the folder and those above it as needed. Refused: a path that is no folder, and a
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
