#pragma once

#include "components/stats.hpp"

namespace handhold {

// A sentence for people: what happened, and what the runtime did instead.
const char* meaning_of(Fallback reason);

}  // namespace handhold
