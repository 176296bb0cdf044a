#pragma once

#include <cstddef>

// Tasks on several threads; only parallel_pool.cpp starts threads. Results must not depend on the
// number of threads: each index writes its own output, and nothing is summed in order of
// completion.
namespace handhold {

// Number of threads for parallel_for, including the caller; may exceed the number of cores. Default
// 1. Throws PreconditionError below 1. Call between frames only, never while parallel_for runs.
void set_thread_count(int count);
int thread_count();

using IndexedTask = void (*)(void* context, std::size_t index);
// A host's job system: calls task(task_context, i) once for every i in [0, count) and returns when
// all are done.
using ParallelBackend = void (*)(void* context, std::size_t count, IndexedTask task,
                                 void* task_context);
// Replaces the library's own threads; null: restores them. Call between frames only.
void set_parallel_backend(ParallelBackend backend, void* context);

// Calls task(context, i) once for every i in [0, count) and returns when all are done. Indices
// start in ascending order: put the largest work first. If there is one thread or one index, or
// inside a task, all indices run in order on the calling thread, without allocation. Tasks must not
// throw.
void parallel_for(std::size_t count, void* context, IndexedTask task);

template <typename F>
void parallel_for(std::size_t count, F& task) {
    parallel_for(count, &task,
                 [](void* context, std::size_t index) { (*static_cast<F*>(context))(index); });
}

// Calls task(slice, first, last) for consecutive ranges of `grain` indices (the last may be
// shorter) that cover [0, count). The ranges do not depend on the number of threads, so a task may
// keep counters and scratch memory per slice.
template <typename F>
void parallel_slices(std::size_t count, std::size_t grain, F& task) {
    const std::size_t slices = (count + grain - 1) / grain;
    auto run = [&](std::size_t slice) {
        const std::size_t first = slice * grain;
        task(slice, first, count - first < grain ? count : first + grain);
    };
    parallel_for(slices, run);
}

// Calls task(i) once for every i in [0, count), in slices of `grain` indices. For tasks that take
// less time than it takes to start one.
template <typename F>
void parallel_each(std::size_t count, std::size_t grain, const F& task) {
    const auto run = [&task](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        for (std::size_t index = first; index < last; ++index) {
            task(index);
        }
    };
    parallel_slices(count, grain, run);
}

}  // namespace handhold
