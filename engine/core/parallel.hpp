#pragma once

#include <cstddef>

// The only place that knows of threads. What runs here must not depend on how many there are: each
// index writes its own output, and nothing is summed in order of arrival.
namespace handhold {

// Threads that parallel_for may use from now on, the caller's included; 1 until this is called,
// also more than there are cores. Throws PreconditionError below 1. Call between frames only, never
// while parallel_for runs.
void set_thread_count(int count);
int thread_count();

using IndexedTask = void (*)(void* context, std::size_t index);
// Calls task(context, i) once for every i in [0, count) and returns when all are done. Indices
// begin in ascending order: put the largest work first. Serial, in order and without allocation on
// the caller's thread for one thread, for one index, and where it is called from inside a task.
// Tasks must not throw.
void parallel_for(std::size_t count, void* context, IndexedTask task);

template <typename F>
void parallel_for(std::size_t count, F& task) {
    parallel_for(count, &task,
                 [](void* context, std::size_t index) { (*static_cast<F*>(context))(index); });
}

}  // namespace handhold
