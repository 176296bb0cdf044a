#pragma once

#if defined(__SANITIZE_THREAD__)
#define HH_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HH_THREAD_SANITIZER 1
#endif
#endif

// Used by parallel.cpp. The distribution's TBB is not instrumented: the thread sanitizer sees
// memory accesses in TBB's headers and in our tasks, but not their ordering. These two functions
// declare the ordering. They are empty in other builds.
namespace handhold {

#ifdef HH_THREAD_SANITIZER
// All that this thread does before release_memory happens before all that other threads do after
// acquire_memory with the same address.
void release_memory(const void* address);
void acquire_memory(const void* address);
#else
inline void release_memory(const void*) {}
inline void acquire_memory(const void*) {}
#endif

}  // namespace handhold
