#include "game/play/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace handhold {

Progress::Progress(std::string what)
    : what_(std::move(what)), on_terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (percent_ >= 0) {
        std::fprintf(stderr, "\r\033[K");
    }
}

void Progress::show(double share) {
    const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
    if (!on_terminal_ || percent == percent_) {
        return;
    }
    percent_ = percent;
    constexpr int k_width = 40;
    const int filled = percent * k_width / 100;
    std::fprintf(stderr, "\r%s [%s%s] %3d %%", what_.c_str(),
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(k_width - filled), ' ').c_str(), percent);
}

}  // namespace handhold
