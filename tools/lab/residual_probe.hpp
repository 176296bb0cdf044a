#pragma once

#include <vector>

#include "components/frame_graph.hpp"

// Residual against iteration: the first island that a frame solves is solved again and again from
// where it stood, with one iteration more each time.
namespace handhold::lab {

// Puts itself between the phases and `solver` from now on; pass what it returns to the run.
PositionSolver probe_residuals(PositionSolver solver);
// The next solve is probed.
void arm_probe();
// Metres: before the first iteration, after it, ...; empty until a solve was probed.
const std::vector<double>& probed_residuals();

}  // namespace handhold::lab
