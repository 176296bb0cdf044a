#pragma once

#include "systems/host/host_world.hpp"

// Samples and commands that a host gives for a step, and samples kept for later steps.
namespace handhold {

enum class StepKind : std::uint8_t { advances, poses_only };
// Checks a step's inputs and fills host.inputs: for each player the samples kept from earlier
// steps, then the given ones. A given sample replaces kept ones of the same time or later.
//
// In a step that advances the clock, a player with kept samples but no input gets an input without
// commands. Samples more than half a second after the step's end are left out, unless the input
// repeats samples. They, and those more than half a second before its start, are counted by
// finish_step. A step of poses only drops all kept samples and takes given ones of any time.
// Nothing else changes, except that the log may be told that samples are on another clock.
void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count,
                 StepKind kind = StepKind::advances);
// Keeps the samples of host.inputs after the step's end, at most EarlySamples::k_capacity a player.
void keep_early_samples(hh_world& host, double end_s);

// Reads one input of an array of the host and its samples: exact times, HH_ERROR_VERSION for other
// versions. Poses that are not tracked, not valid or too far away are NaN.
TrackingSample exact_sample(const hh_tracking_sample* samples, std::size_t i);
PlayerCommands read_commands(const hh_commands& commands);

}  // namespace handhold
