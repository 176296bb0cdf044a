#include "engine/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include "engine/core/check.hpp"
#include "engine/core/thread_sanitizer.hpp"

namespace handhold {
namespace {

// The threads persist between calls. If `count` is one, there are no threads and TBB is not used.
struct Workers {
    std::optional<tbb::global_control> limit;  // allows more threads than cores
    std::optional<tbb::task_arena> arena;
    int count = 1;
    ParallelBackend backend = nullptr;
    void* backend_context = nullptr;
};

Workers& workers() {
    static Workers instance;
    return instance;
}

// True inside a task. Nested calls run serially: while waiting, a thread could otherwise start
// another outer task in the middle of its own.
thread_local bool t_in_task = false;

class InTask {
  public:
    InTask() { t_in_task = true; }
    ~InTask() { t_in_task = false; }
    InTask(const InTask&) = delete;
    InTask& operator=(const InTask&) = delete;
};

// The work of one call. Each runner claims the next index, so the first (largest) tasks start
// first. Unlike with a fixed partition, no runner is left with too much work.
struct Job {
    const std::size_t count;
    void* const context;
    const IndexedTask task;
    std::atomic<std::size_t> next = 0;
};

// A task in the hands of a ParallelBackend.
struct LentTask {
    void* const context;
    const IndexedTask task;

    static void run(void* lent, std::size_t index) {
        const InTask in_task;
        const LentTask& self = *static_cast<const LentTask*>(lent);
        self.task(self.context, index);
    }
};

void run_claimed(Job& job) {
    acquire_memory(&job);
    {
        const InTask in_task;
        const auto claim = [&] { return job.next.fetch_add(1, std::memory_order_relaxed); };
        for (std::size_t i = claim(); i < job.count; i = claim()) {
            job.task(job.context, i);
        }
    }
    release_memory(&job);
}

void run_serial(std::size_t count, void* context, IndexedTask task) {
    for (std::size_t i = 0; i < count; ++i) {
        task(context, i);
    }
}

}  // namespace

void set_thread_count(int count) {
    HH_CHECK(count >= 1, "at least one thread is needed", count);
    HH_CHECK(!t_in_task, "called from inside a task", count);
    Workers& state = workers();
    if (count == state.count) {
        return;
    }
    state.arena.reset();
    state.limit.reset();
    state.count = count;
    if (count > 1) {
        const auto threads = static_cast<std::size_t>(count);
        state.limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
        state.arena.emplace(count);
    }
}

void set_parallel_backend(ParallelBackend backend, void* context) {
    HH_CHECK(!t_in_task, "called from inside a task", 0);
    workers().backend = backend;
    workers().backend_context = context;
}

int thread_count() { return workers().count; }

void parallel_for(std::size_t count, void* context, IndexedTask task) {
    Workers& state = workers();
    if (count >= 2 && state.backend != nullptr && !t_in_task) {
        LentTask lent{context, task};
        state.backend(state.backend_context, count, &LentTask::run, &lent);
        return;
    }
    if (count < 2 || state.count == 1 || t_in_task) {
        run_serial(count, context, task);
        return;
    }
    Job job{count, context, task};
    const std::size_t runners = std::min(count, static_cast<std::size_t>(state.count));
    // The sanitizer cannot follow how TBB passes these two lambdas to other threads.
    // Instrumentation resumes in run_claimed.
    const auto run = [&](std::size_t) __attribute__((no_sanitize("thread"))) { run_claimed(job); };
    const auto run_all = [&]() __attribute__((no_sanitize("thread"))) {
        tbb::parallel_for(std::size_t{0}, runners, run, tbb::simple_partitioner());
    };
    release_memory(&job);
    state.arena->execute(run_all);
    acquire_memory(&job);
}

}  // namespace handhold
