#include "game/play/loading.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include <unistd.h>

#include "engine/core/work_meter.hpp"
#include "game/files/file_tools.hpp"
#include "game/levels/load_scene.hpp"
#include "game/play/progress.hpp"

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
    AllThreads() : before_(hh_thread_count()) {
        hh_set_thread_count(std::clamp(std::thread::hardware_concurrency(), before_, 256U));
    }
    ~AllThreads() { hh_set_thread_count(before_); }
    AllThreads(const AllThreads&) = delete;
    AllThreads& operator=(const AllThreads&) = delete;

  private:
    std::uint32_t before_;
};

// Returns the user's cache folder, whose files may be deleted at any time. Empty if the environment
// names none.
std::filesystem::path user_cache_directory() {
    const auto folder = [](const char* variable) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): no thread changes the environment
        const char* const value = std::getenv(variable);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    // Relative paths count as unset (XDG base directory specification).
    if (const std::filesystem::path cache = folder("XDG_CACHE_HOME"); cache.is_absolute()) {
        return cache / "handhold";
    }
    if (const std::filesystem::path home = folder("HOME"); home.is_absolute()) {
        return home / ".cache" / "handhold";
    }
    return {};
}

}  // namespace

Result<Scene> load_scene_with_progress(const std::string& name_or_file) {
    const std::filesystem::path cache = user_cache_directory();
    set_grip_mesh_cache(cache.empty() ? cache : cache / "grip_meshes");
    const LoadingBar bar(name_or_file);
    const AllThreads threads;
    return load_scene(name_or_file);
}

}  // namespace handhold
