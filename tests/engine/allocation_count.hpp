#pragma once

#include <cstddef>
#include <cstdint>

namespace handhold {

// Number of operator new calls (all forms) by the calling thread so far. allocation_count.cpp
// replaces the global operators in every test executable. Only compare counts for equality, and
// only if counts_allocations() is true: sanitizers have their own operators.
std::size_t allocation_count();
// Total bytes requested by those calls, including freed ones.
std::size_t allocated_bytes();
bool counts_allocations();
// Number of allocations by Bullet in this process since the first call. That call hooks Bullet's
// allocator, which the library leaves to its host; blocks from before may be freed through it.
std::uint64_t collision_allocation_count();

}  // namespace handhold
