#pragma once

#include <cstddef>

namespace handhold {

// Number of operator new calls (all forms) by the calling thread so far. allocation_count.cpp
// replaces the global operators in every test executable. Only compare counts for equality, and
// only if counts_allocations() is true: sanitizers have their own operators.
std::size_t allocation_count();
// Total bytes requested by those calls, including freed ones.
std::size_t allocated_bytes();
bool counts_allocations();

}  // namespace handhold
