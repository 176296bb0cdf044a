#pragma once

#include <vector>

#include "systems/physics/solve_phases.hpp"

// Residual by iteration: solves the first island of a frame repeatedly from the same start, each
// time with one iteration more.
namespace handhold::lab {

// Wraps `solver` with the probe. Pass the returned solver to the run.
PositionSolver probe_residuals(PositionSolver solver);
// Probes the next solve.
void arm_probe();
// Metres: before the first iteration, after it, and so on. Empty if no solve was probed.
const std::vector<double>& probed_residuals();

}  // namespace handhold::lab
