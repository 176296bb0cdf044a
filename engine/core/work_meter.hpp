#pragma once

#include <atomic>
#include <cstdint>

namespace handhold {

// How far long work has come, in units of its own, for a progress bar: whoever works adds to it,
// any thread may read it. One for the process.
struct WorkMeter {
    std::atomic<std::uint64_t> planned = 0;
    std::atomic<std::uint64_t> done = 0;
};

inline WorkMeter& work_meter() {
    static WorkMeter meter;
    return meter;
}

}  // namespace handhold
