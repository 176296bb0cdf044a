#pragma once

#include <atomic>

namespace handhold {

// Number of worlds of the C interface. Hooks can be set only while it is 0.
std::atomic<int>& world_count();

}  // namespace handhold
