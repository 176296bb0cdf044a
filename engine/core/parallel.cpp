#include "engine/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>

#include "engine/core/check.hpp"
#include "engine/core/float_environment.hpp"
#include "engine/core/parallel_pool.hpp"
#include "engine/core/thread_sanitizer.hpp"

namespace handhold {
namespace {

struct Workers {
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

  private:
    FloatEnvironment environment_;  // a worker's may differ from the caller's
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

void run_claimed(void* context, std::size_t /*runner*/) {
    Job& job = *static_cast<Job*>(context);
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
    resize_pool(count);
    state.count = count;
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
    release_memory(&job);
    run_on_pool(std::min(count, static_cast<std::size_t>(state.count)), &job, &run_claimed);
    acquire_memory(&job);
}

}  // namespace handhold
