#pragma once

#include "components/tuning.hpp"

namespace handhold {

// Throws PreconditionError if a number is NaN or outside its range in visit_tuning, or if
// phases.kappa_heavy_kg is not above phases.kappa_light_kg. The message has the number's name and
// value.
void check_tuning(const Tuning& tuning);

}  // namespace handhold
