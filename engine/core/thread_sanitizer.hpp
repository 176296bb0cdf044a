#pragma once

#if defined(__SANITIZE_THREAD__)
#define HH_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HH_THREAD_SANITIZER 1
#endif
#endif

// For parallel.cpp. The distribution's task library is not instrumented: a thread sanitizer sees
// what its headers and our tasks access, but not how it orders them. These two tell it; they are
// empty in all other builds.
namespace handhold {

#ifdef HH_THREAD_SANITIZER
// All that this thread did so far comes before what others do after acquire_memory of the same
// address.
void release_memory(const void* address);
void acquire_memory(const void* address);
#else
inline void release_memory(const void*) {}
inline void acquire_memory(const void*) {}
#endif

}  // namespace handhold
