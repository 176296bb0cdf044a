#pragma once

#include <chrono>
#include <cstdint>

// The machine's monotonic clock, for loops that follow real time and measure their cost.
namespace handhold {

inline std::int64_t clock_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}
inline double us_since(std::int64_t begin_ns) {
    return 1e-3 * static_cast<double>(clock_ns() - begin_ns);
}

}  // namespace handhold
