#include "engine/core/parallel_pool.hpp"

#include <optional>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace handhold {
namespace {

struct Pool {
    std::optional<tbb::global_control> limit;  // allows more threads than cores
    std::optional<tbb::task_arena> arena;
};

Pool& pool() {
    static Pool instance;
    return instance;
}

}  // namespace

void resize_pool(int threads) {
    pool().arena.reset();
    pool().limit.reset();
    if (threads > 1) {
        pool().limit.emplace(tbb::global_control::max_allowed_parallelism,
                             static_cast<std::size_t>(threads));
        pool().arena.emplace(threads);
    }
}

void run_on_pool(std::size_t runners, void* context, IndexedTask runner) {
    // The sanitizer cannot follow how TBB passes these two lambdas to other threads.
    // Instrumentation resumes in the runner.
    const auto run = [&](std::size_t i) __attribute__((no_sanitize("thread"))) {
        runner(context, i);
    };
    const auto run_all = [&]() __attribute__((no_sanitize("thread"))) {
        tbb::parallel_for(std::size_t{0}, runners, run, tbb::simple_partitioner());
    };
    pool().arena->execute(run_all);
}

}  // namespace handhold
