#pragma once

#include "systems/host/host_world.hpp"

// What every kind of step of the C interface does around its stages.
namespace handhold {

// Checks and fills host.inputs. Nothing else changes.
void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count);
// Keeps each player's first sample of after the step's end. A player without an input keeps the one
// that is there.
void keep_early_samples(hh_world& host, double end_s);
using HostStep = void (*)(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&);
// A whole step. Without events the clock stands still.
hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    HostStep step, bool makes_events);
// After a step's stages: answers that were ignored, and shapes that were removed before it.
void finish_step(hh_world& host);

}  // namespace handhold
