#pragma once

#include "systems/host/host_world.hpp"

// Samples and commands that a host gives for a step, and samples kept for later steps.
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

}  // namespace handhold
