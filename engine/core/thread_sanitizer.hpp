#pragma once

#if defined(__SANITIZE_THREAD__)
#define HH_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HH_THREAD_SANITIZER 1
#endif
#endif

// For parallel.cpp. The distribution's TBB is not instrumented: the thread sanitizer sees memory
// accesses in its headers and our tasks, but not their ordering. These two functions declare the
// ordering; they are empty in other builds.
namespace handhold {

#ifdef HH_THREAD_SANITIZER
// Everything this thread did before happens before what others do after acquire_memory with the
// same address.
void release_memory(const void* address);
void acquire_memory(const void* address);
#else
inline void release_memory(const void*) {}
inline void acquire_memory(const void*) {}
#endif

}  // namespace handhold
