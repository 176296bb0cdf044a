#include "game/commands/loading.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include <unistd.h>

#include "engine/core/parallel.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/io/printable.hpp"
#include "game/commands/progress.hpp"

namespace handhold {
namespace {

// Shows work_meter() in the terminal, from a thread of its own. Does nothing if standard error is
// not a terminal.
class LoadingBar {
  public:
    explicit LoadingBar(const std::string& what) {
        if (isatty(STDERR_FILENO) != 0) {
            work_meter().planned = 0;
            work_meter().done = 0;
            thread_.emplace([this, what] { show(what); });
        }
    }
    ~LoadingBar() {
        is_over_ = true;
        if (thread_) {
            thread_->join();
        }
    }
    LoadingBar(const LoadingBar&) = delete;
    LoadingBar& operator=(const LoadingBar&) = delete;

  private:
    void show(const std::string& what) {
        Progress progress("loading " + printable(what, k_max_shown_name));
        while (!is_over_) {
            const auto planned = static_cast<double>(work_meter().planned.load());
            const auto done = static_cast<double>(work_meter().done.load());
            progress.show(planned > 0.0 ? done / planned : 0.0);
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }

    std::atomic<bool> is_over_ = false;
    std::optional<std::thread> thread_;
};

class AllThreads {
  public:
    AllThreads() : before_(thread_count()) {
        set_thread_count(std::max(before_, static_cast<int>(std::thread::hardware_concurrency())));
    }
    ~AllThreads() { set_thread_count(before_); }
    AllThreads(const AllThreads&) = delete;
    AllThreads& operator=(const AllThreads&) = delete;

  private:
    int before_;
};

}  // namespace

Result<Scene> load_scene_with_progress(const std::string& name_or_file) {
    const LoadingBar bar(name_or_file);
    const AllThreads threads;
    return load_scene(name_or_file);
}

}  // namespace handhold
