#pragma once

#include "systems/host/host_world.hpp"

// Shared by the step functions of the C interface: the work before and after the stages of a step.
namespace handhold {

using HostStep = void (*)(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&);
// Checks the inputs and runs a whole step. makes_events: false if `step` does not advance the
// clock; samples of later steps are then dropped, and only grips that ended since the last step
// make events.
hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    HostStep step, bool makes_events);
// Call after a step's stages. Counts the invalid answers of the host's surface queries and the
// samples too far ahead or too old, and recycles shapes that were removed before the step.
void finish_step(hh_world& host);

}  // namespace handhold
