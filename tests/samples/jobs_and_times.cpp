// The guide's job system: the host runs the library's parallel work, and reads where time goes.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

std::atomic<int> g_jobs{0};

// [jobs]
// Yours would hand the indices to workers that wait for work. This one starts threads.
void parallel_for(void* /*context*/, size_t count, hh_task task, void* task_context) {
    std::atomic<size_t> next{0};
    const auto work = [&] {
        for (size_t i = next++; i < count; i = next++) {
            task(task_context, i);
            ++g_jobs;
        }
    };
    std::thread helper(work);
    work();
    helper.join();
}

void log(void* /*context*/, hh_log_level /*level*/, const char* message) {
    std::fprintf(stderr, "handhold: %s\n", message);
}

bool lend_jobs() {  // once, before the first world
    hh_host_hooks hooks = hh_default_host_hooks();
    hooks.parallel_for = &parallel_for;
    hooks.log = &log;
    return hh_set_host_hooks(&hooks) == HH_OK;
}
// [jobs]

std::uint64_t play() {
    hh::World world;
    hh_body_def crate = hh::body_def();
    crate.kind = HH_DYNAMIC;
    crate.shape = *world.add_box({0.1, 0.1, 0.1});
    for (int i = 0; i < 20; ++i) {
        crate.pose.position = {0.25 * i, 0.0, 0.0};
        crate.velocity_mps = {i % 2 == 0 ? 0.3 : -0.3, 0.0, 0.0};
        (void)world.add(crate);
    }
    for (int frame = 0; frame < 60; ++frame) {
        if (!world.step(1.0 / 90.0)) {
            return 0;
        }
    }
    // [times]
    std::vector<double> us(64);
    size_t count = 0;
    if (hh_world_stage_times(world.get(), us.data(), us.size(), &count) == HH_OK) {
        const auto slowest = std::max_element(us.begin(), us.begin() + static_cast<long>(count));
        std::printf("slowest stage: %s, %.0f us\n",
                    hh_stage_name(static_cast<size_t>(slowest - us.begin())), *slowest);
    }
    // [times]
    return world.hash();
}

}  // namespace

int main() {
    const std::uint64_t serial = play();
    if (!lend_jobs()) {
        return 1;
    }
    const std::uint64_t parallel = play();
    std::printf("%d jobs; hashes %s\n", g_jobs.load(), serial == parallel ? "equal" : "differ");
    return serial != 0 && serial == parallel && g_jobs > 0 && hh_set_host_hooks(nullptr) == HH_OK
               ? 0
               : 1;
}
