#pragma once

#include <atomic>

namespace handhold {

// Number of worlds of the C interface: hooks change only while there is none.
std::atomic<int>& world_count();

}  // namespace handhold
