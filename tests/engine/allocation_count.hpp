#pragma once

#include <cstddef>

namespace handhold {

// How often the calling thread has called operator new, in any form, since it began. The whole test
// executable counts: allocation_count.cpp, which all of them have, replaces the global operators.
// Only equality of two counts means anything, and nothing where counts_allocations() is false: the
// sanitizers bring operators of their own.
std::size_t allocation_count();
// How many bytes it has asked for so; what was given back counts too.
std::size_t allocated_bytes();
bool counts_allocations();

}  // namespace handhold
