#pragma once

#include "systems/host/host_world.hpp"

// Work that the step functions of the C interface share: it runs before and after their stages.
namespace handhold {

using HostStep = void (*)(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&);
// Checks the inputs and runs a whole step. makes_events: false if `step` does not advance the
// clock.
hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    HostStep step, bool makes_events);
// Call after a step's stages. Counts invalid answers of the host's surface queries. Recycles shapes
// that were removed before the step.
void finish_step(hh_world& host);

}  // namespace handhold
