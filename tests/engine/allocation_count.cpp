#include "allocation_count.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HH_SANITIZER_OPERATORS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HH_SANITIZER_OPERATORS 1
#endif
#endif

// Of Bullet, LinearMath/btAlignedAllocator.h: this source has not its include path.
void btAlignedAllocSetCustom(void* (*allocate)(std::size_t), void (*release)(void*));

namespace {

std::atomic<std::uint64_t> g_collision_allocations{0};

void* allocate_counted(std::size_t size) {
    g_collision_allocations.fetch_add(1, std::memory_order_relaxed);
    return std::malloc(size);
}

thread_local std::size_t t_allocations = 0;
thread_local std::size_t t_bytes = 0;

}  // namespace

#ifndef HH_SANITIZER_OPERATORS
// The standard library's other forms (array, nothrow, sized) call these.
void* operator new(std::size_t size) {
    ++t_allocations;
    t_bytes += size;
    if (void* const memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++t_allocations;
    t_bytes += size;
    const auto boundary = static_cast<std::size_t>(alignment);
    const std::size_t whole = (size + boundary - 1) / boundary * boundary;
    if (void* const memory = std::aligned_alloc(boundary, whole == 0 ? boundary : whole)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace handhold {

std::size_t allocation_count() { return t_allocations; }
std::size_t allocated_bytes() { return t_bytes; }

std::uint64_t collision_allocation_count() {
    static const bool hooked = [] {
        btAlignedAllocSetCustom(&allocate_counted, &std::free);
        return true;
    }();
    return hooked ? g_collision_allocations.load(std::memory_order_relaxed) : 0;
}

bool counts_allocations() {
#ifdef HH_SANITIZER_OPERATORS
    return false;
#else
    return true;
#endif
}

}  // namespace handhold
