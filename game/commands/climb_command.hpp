#pragma once

#include <cstdint>
#include <string>

namespace handhold {

// Options of `handhold climb`.
struct ClimbOptions {
    std::string scene;
    std::string spawn;  // name of the spawn; empty: the scene's first
    std::string out;    // file for the recording
    double seconds = 20.0;
    std::uint64_t seed = 1;
};
// Records a wandering climber. Returns the exit status: 0; k_exit_bad_file, after one line on
// standard error, if a file is invalid or cannot be written; k_exit_interrupted if a signal ended
// the session. An interrupted recording is saved too.
int climb_command(const ClimbOptions& options);

}  // namespace handhold
