// parallel.hpp for builds without threads (HANDHOLD_THREADS=OFF): any thread count is accepted and
// all work runs on the caller, unless the host lends a job system.
#include <string>

#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"

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

thread_local bool t_in_task = false;

// Runs one task; nested calls of parallel_for are then serial.
struct Task {
    void* const context;
    const IndexedTask task;

    static void run(void* self, std::size_t index) {
        const Task& task = *static_cast<const Task*>(self);
        const bool before = t_in_task;
        t_in_task = true;
        task.task(task.context, index);
        t_in_task = before;
    }
};

}  // namespace

void set_thread_count(int count) {
    HH_CHECK(count >= 1, "at least one thread is needed", count);
    HH_CHECK(!t_in_task, "called from inside a task", count);
    workers().count = count;
}

void set_parallel_backend(ParallelBackend backend, void* context) {
    HH_CHECK(!t_in_task, "called from inside a task", 0);
    workers().backend = backend;
    workers().backend_context = context;
}

int thread_count() { return workers().count; }

void parallel_for(std::size_t count, void* context, IndexedTask task) {
    const Workers& state = workers();
    Task lent{context, task};
    if (count >= 2 && state.backend != nullptr && !t_in_task) {
        state.backend(state.backend_context, count, &Task::run, &lent);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        Task::run(&lent, i);
    }
}

}  // namespace handhold
