#pragma once

#include <algorithm>
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

// Converts real time to a number of simulation steps.
class StepClock {
  public:
    // Maximum delay behind real time, s; beyond it, simulated time runs slower.
    static constexpr double k_max_behind_s = 0.1;

    explicit StepClock(double step_s) : step_s_(step_s) {}
    // The number of steps that have become due since the last call.
    int advance() {
        const std::int64_t now = clock_ns();
        behind_s_ += last_ns_ != 0 ? 1e-9 * static_cast<double>(now - last_ns_) : 0.0;
        behind_s_ = std::min(behind_s_, k_max_behind_s);
        last_ns_ = now;
        const auto due = static_cast<int>(behind_s_ / step_s_);
        behind_s_ -= due * step_s_;
        return due;
    }

  private:
    double step_s_;
    std::int64_t last_ns_ = 0;
    double behind_s_ = 0.0;
};

}  // namespace handhold
