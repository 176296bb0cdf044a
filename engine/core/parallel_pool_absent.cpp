// parallel_pool.hpp without threads (HANDHOLD_THREADS=OFF).
#include "engine/core/parallel_pool.hpp"

namespace handhold {

void resize_pool(int /*threads*/) {}

void run_on_pool(std::size_t /*runners*/, void* context, IndexedTask runner) { runner(context, 0); }

}  // namespace handhold
