#pragma once

#include "components/stats.hpp"

namespace handhold {

// A sentence for readers of a report: what happened, and what the runtime did instead.
const char* meaning_of(Fallback reason);

}  // namespace handhold
