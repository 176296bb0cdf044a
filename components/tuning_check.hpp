#pragma once

#include "components/tuning.hpp"

namespace handhold {

// Throws PreconditionError, with the number's name and value, unless every number lies in the range
// of visit_tuning (NaN never does) and phases.kappa_heavy_kg is above kappa_light_kg.
void check_tuning(const Tuning& tuning);

}  // namespace handhold
