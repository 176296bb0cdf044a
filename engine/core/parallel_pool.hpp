#pragma once

#include <cstddef>

#include "engine/core/parallel.hpp"

// The threads behind parallel_for: TBB's, or none (HANDHOLD_THREADS=OFF). For parallel.cpp.
namespace handhold {

// Number of threads, including the caller; at least 1. The threads persist between calls.
void resize_pool(int threads);

// Calls runner(context, i) for i in [0, runners), at the same time as far as threads are free, and
// returns when all are done. Without threads only the first runner is called: any runner can do all
// of the work.
void run_on_pool(std::size_t runners, void* context, IndexedTask runner);

}  // namespace handhold
