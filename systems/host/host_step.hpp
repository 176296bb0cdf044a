#pragma once

#include "systems/host/host_world.hpp"

// Work that the step functions of the C interface share: it runs before and after their stages.
namespace handhold {

enum class StepKind : std::uint8_t { advances, poses_only };
// Checks and fills host.inputs: the samples kept from earlier steps, then those given. A sample
// given now replaces those kept of its time or later. Players who have kept samples and no input
// get one without commands in a step that advances. Samples too far ahead are left out; they and
// those too old are counted by finish_step. Nothing else changes.
void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count,
                 StepKind kind = StepKind::advances);
// Keeps the samples of host.inputs after the step's end, at most EarlySamples::k_capacity a player.
void keep_early_samples(hh_world& host, double end_s);
using HostStep = void (*)(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&);
// Checks the inputs and runs a whole step. makes_events: false if `step` does not advance the
// clock.
hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    HostStep step, bool makes_events);
// Call after a step's stages. Counts invalid answers of the host's surface queries. Recycles shapes
// that were removed before the step.
void finish_step(hh_world& host);

}  // namespace handhold
