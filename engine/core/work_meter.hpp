#pragma once

#include <atomic>
#include <cstdint>

namespace handhold {

// Progress of long work, for a progress bar. The code that does the work counts it, in units of its
// choice; any thread may read it. There is one meter per process.
struct WorkMeter {
    std::atomic<std::uint64_t> planned = 0;
    std::atomic<std::uint64_t> done = 0;
};

inline WorkMeter& work_meter() {
    static WorkMeter meter;
    return meter;
}

}  // namespace handhold
