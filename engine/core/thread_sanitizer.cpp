#include "engine/core/thread_sanitizer.hpp"

#ifdef HH_THREAD_SANITIZER

// Defined in the sanitizer's run-time library.
extern "C" void __tsan_release(void* address);
extern "C" void __tsan_acquire(void* address);

// Suppresses reports about TBB's own objects, never about code inside a task. The patterns match
// the innermost function, or functions from which no task is called.
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libtbb.so\n"
           "race_top:tbb::detail\n"
           "race:tbb::detail::d1::wait_context\n"
           "race:tbb::detail::d1::wait_node\n"
           "race:tbb::detail::d1::tree_node\n"
           "race:tbb::detail::d1::fold_tree\n"
           "race:tbb::detail::d1::small_object_allocator\n";
}

namespace handhold {

void release_memory(const void* address) { __tsan_release(const_cast<void*>(address)); }
void acquire_memory(const void* address) { __tsan_acquire(const_cast<void*>(address)); }

}  // namespace handhold

#endif
