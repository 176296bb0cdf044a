#include "game/headset/headset_clock.hpp"

#include <cmath>

namespace handhold {
namespace {

constexpr double k_ns_per_s = 1e9;
constexpr double k_steps_per_hz = 1e3;  // rounds to 1 mHz: 11,111,111 ns are 90 Hz, not 90.0000009

}  // namespace

int HeadsetClock::advance(std::int64_t display_ns, std::int64_t period_ns) {
    if (!runs_) {
        runs_ = true;
        if (period_ns > 0 && !has_hz_) {
            const double hz = k_ns_per_s / static_cast<double>(period_ns);
            hz_ = std::round(hz * k_steps_per_hz) / k_steps_per_hz;
            has_hz_ = true;
        }
        begin_ns_ = display_ns - std::llround(static_cast<double>(done_) / hz_ * k_ns_per_s);
        return 0;
    }
    const double since_s = static_cast<double>(display_ns - begin_ns_) / k_ns_per_s;
    const auto until = static_cast<std::int64_t>(std::llround(since_s * hz_));
    std::int64_t due = until - done_;
    if (due <= 0) {
        return 0;
    }
    if (due > k_max_frames) {
        const std::int64_t lost = due - k_max_frames;
        begin_ns_ += std::llround(static_cast<double>(lost) / hz_ * k_ns_per_s);
        due = k_max_frames;
    }
    done_ += due;
    return static_cast<int>(due);
}

std::int64_t HeadsetClock::frame_ns(int before_last) const {
    const double since_s = static_cast<double>(done_ - before_last) / hz_;
    return begin_ns_ + std::llround(since_s * k_ns_per_s);
}

}  // namespace handhold
