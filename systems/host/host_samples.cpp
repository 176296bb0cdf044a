// Reads the inputs of a step (handhold/world.h): samples and commands of players.
#include "systems/host/host_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {
namespace {

constexpr double k_min_step_s = 1e-6;
constexpr double k_max_step_s = 10.0;

// Returns the pose, or NaN, which read_tracking ignores, if the pose is not tracked, not valid or
// too far away.
Pose tracked_or_invalid(const Pose& pose, bool is_tracked) {
    Pose read;
    if (is_tracked && is_valid(pose) &&
        pose.position.cwiseAbs().maxCoeff() < k_farthest_tracked_m) {
        return pose;
    }
    read.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    return read;
}

// Returns the sample's time; the step's end if the sample is later by rounding errors only. A host
// may compute the step's end in another way than the world's clock, such as from a frame number.
double without_rounding_s(double time_s, double end_s) {
    constexpr double k_rounding_s = 1e-6;
    return time_s > end_s && time_s <= end_s + k_rounding_s ? end_s : time_s;
}

TrackingSample read_sample(const hh_tracking_sample& sample, double end_s, bool is_exact) {
    TrackingSample read;
    read.t_s = is_exact ? sample.time_s : without_rounding_s(sample.time_s, end_s);
    read.head_ps = tracked_or_invalid(unchecked_pose(sample.head),
                                      sample.head_tracked != 0 || sample.head_inferred != 0);
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        read.controllers[i].controller_ps =
            tracked_or_invalid(unchecked_pose(sample.hands[i]),
                               sample.hand_tracked[i] != 0 || sample.hand_inferred[i] != 0);
        read.controllers[i].grab = sample.grab[i] != 0;
        read.controllers[i].squeeze = sample.squeeze[i];
        read.controllers[i].trigger = sample.trigger[i];
        read.controllers[i].is_inferred = sample.hand_inferred[i] != 0;
        std::copy_n(sample.curls[i].fingers, k_finger_count, read.controllers[i].curls.begin());
    }
    read.is_head_inferred = sample.head_inferred != 0;
    return read;
}

TrackingSample read_sample(const EarlySample& sample) {
    TrackingSample read;
    read.t_s = sample.t_s;
    read.head_ps = tracked_or_invalid(sample.head_ps, sample.head_tracked);
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        read.controllers[i].controller_ps =
            tracked_or_invalid(sample.controllers_ps[i], sample.tracked[i]);
        read.controllers[i].grab = sample.grab[i];
        read.controllers[i].squeeze = sample.squeeze[i];
        read.controllers[i].trigger = sample.trigger[i];
        read.controllers[i].is_inferred = sample.inferred[i];
        read.controllers[i].curls = sample.curls[i];
    }
    read.is_head_inferred = sample.head_inferred;
    return read;
}

EarlySample early_of(const TrackingSample& sample) {
    EarlySample early;
    early.t_s = sample.t_s;
    early.head_tracked = is_valid(sample.head_ps);
    early.head_ps = early.head_tracked ? sample.head_ps : Pose{};
    early.head_inferred = sample.is_head_inferred;
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const Pose& controller_ps = sample.controllers[i].controller_ps;
        early.tracked[i] = is_valid(controller_ps);
        early.controllers_ps[i] = early.tracked[i] ? controller_ps : Pose{};
        early.grab[i] = sample.controllers[i].grab;
        early.squeeze[i] = pressed_share(sample.controllers[i].squeeze);
        early.trigger[i] = pressed_share(sample.controllers[i].trigger);
        early.inferred[i] = sample.controllers[i].is_inferred;
        early.curls[i] = known_curls(sample.controllers[i].curls);
    }
    return early;
}

// Adds an input without commands for each player who has kept samples but no input.
void add_silent_inputs(hh_world& host) {
    const std::size_t given = host.inputs.size();
    for (const Entity player : host.world.early_samples.owners()) {
        const auto end = host.inputs.begin() + static_cast<std::ptrdiff_t>(given);
        if (std::none_of(host.inputs.begin(), end,
                         [&](const PlayerInput& input) { return input.player == player; })) {
            host.inputs.push_back({player, {}, {}});
            host.repeats_samples.push_back(0);
        }
    }
}

// Logs, once per world, that a player's samples are on another clock. `off_s`: time of the last
// sample after the step's end.
void name_other_clock(hh_world& host, double off_s) {
    if (host.has_named_clock) {
        return;
    }
    host.has_named_clock = true;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "samples are stamped %.3f s %s the step: time_s must be on the world's clock, "
                  "hh_world_time plus dt_s for the step's end",
                  std::abs(off_s), off_s > 0.0 ? "after" : "before");
    log_note(text.data());
}

// Logs, once per world, that a device counts as not tracked because its pose is not valid.
void name_invalid_pose(hh_world& host, const hh_tracking_sample& sample) {
    if (host.has_named_pose) {
        return;
    }
    const auto is_given = [](std::uint8_t is_tracked, std::uint8_t is_inferred) {
        return is_tracked != 0 || is_inferred != 0;
    };
    struct Device {
        const char* name;
        const hh_pose& pose;
        bool is_given;
    };
    const std::array<Device, 3> devices = {
        {{"the head", sample.head, is_given(sample.head_tracked, sample.head_inferred)},
         {"the left hand", sample.hands[HH_LEFT],
          is_given(sample.hand_tracked[HH_LEFT], sample.hand_inferred[HH_LEFT])},
         {"the right hand", sample.hands[HH_RIGHT],
          is_given(sample.hand_tracked[HH_RIGHT], sample.hand_inferred[HH_RIGHT])}}};
    for (const Device& device : devices) {
        if (!device.is_given || is_valid(unchecked_pose(device.pose))) {
            continue;
        }
        host.has_named_pose = true;
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(),
                      "%s of a tracking sample is ignored: a pose needs finite numbers and a "
                      "rotation of length 1 (hh_identity_pose has one)",
                      device.name);
        log_note(text.data());
        return;
    }
}

// Appends the samples given for a player, except those too far ahead. In a pause the world's clock
// stands still, so samples of any time are appended.
void read_given(hh_world& host, const hh_player_input& input, double end_s, StepKind kind) {
    constexpr double k_far_s = 0.5;
    const double start_s = host.world.clock.t_s;
    const bool has_range = kind == StepKind::advances && input.repeats_samples == 0;
    std::size_t far = 0;
    double last_s = 0.0;
    const hh_tracking_sample defaults = hh_default_tracking_sample();
    for (std::size_t i = 0; i < input.sample_count; ++i) {
        const hh_tracking_sample sample = read_def_at(input.samples, i, defaults);
        last_s = sample.time_s;
        name_invalid_pose(host, sample);
        if (has_range && sample.time_s > end_s + k_far_s) {
            ++host.samples_too_far_ahead;
            ++far;
            continue;
        }
        if (kind == StepKind::advances && sample.time_s < start_s - k_far_s) {
            ++host.samples_too_old;
            ++far;
        }
        host.samples.push_back(read_sample(sample, end_s, input.repeats_samples != 0));
    }
    if (far > 0 && far == input.sample_count) {
        name_other_clock(host, last_s - end_s);
    }
}

}  // namespace

PlayerCommands read_commands(const hh_commands& commands) {
    return {commands.smooth_turn, commands.snap_turns, commands.brake, from_c(commands.thrust),
            commands.calibrate != 0};
}

TrackingSample exact_sample(const hh_tracking_sample* samples, std::size_t i) {
    return read_sample(read_def_at(samples, i, hh_default_tracking_sample()), 0.0, true);
}

void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count,
                 StepKind kind) {
    checked(dt_s, k_min_step_s, k_max_step_s, "dt_s must lie in [1e-6, 10]");
    require(count == 0 || inputs != nullptr, HH_ERROR_NULL, "the inputs are null");
    require_at_most(count, host.world.player.size(), "inputs", "players");
    host.inputs.clear();
    host.repeats_samples.clear();
    host.samples.clear();
    host.samples_too_far_ahead = host.samples_too_old = 0;
    std::size_t sample_count = 0;
    const hh_player_input input_defaults = hh_default_player_input();
    const hh_tracking_sample sample_defaults = hh_default_tracking_sample();
    for (std::size_t i = 0; i < count; ++i) {
        const hh_player_input input = read_def_at(inputs, i, input_defaults);
        require(input.sample_count == 0 || input.samples != nullptr, HH_ERROR_NULL,
                "an input's samples are null");
        constexpr std::size_t k_max_samples = 1U << 16U;
        require(input.sample_count <= k_max_samples, HH_ERROR_VALUE,
                "an input has more than 2^16 samples");
        for (std::size_t j = 0; j < input.sample_count; ++j) {
            read_def_at(input.samples, j, sample_defaults);
        }
        const Entity player = player_of(host, input.player);
        for (const PlayerInput& other : host.inputs) {
            require(other.player != player, HH_ERROR_VALUE, "a player has two inputs");
        }
        host.inputs.push_back({player, {}, read_commands(input.commands)});
        host.repeats_samples.push_back(input.repeats_samples != 0 ? 1 : 0);
        sample_count += input.sample_count;
    }
    const double end_s = host.world.clock.t_s + dt_s;
    if (kind == StepKind::advances) {
        add_silent_inputs(host);
    } else {
        host.world.early_samples.clear();  // After a pause, devices are elsewhere.
    }
    for (const PlayerInput& input : host.inputs) {
        const EarlySamples* const early = host.world.early_samples.find(input.player);
        sample_count += early != nullptr ? early->count : 0;
    }
    host.samples.reserve(sample_count);  // spans into it must not move
    for (std::size_t i = 0; i < host.inputs.size(); ++i) {
        PlayerInput& input = host.inputs[i];
        const hh_player_input given =
            i < count ? read_def_at(inputs, i, input_defaults) : input_defaults;
        const std::size_t first = host.samples.size();
        if (const EarlySamples* const early = host.world.early_samples.find(input.player)) {
            for (std::uint32_t j = 0; j < early->count; ++j) {
                const EarlySample& kept = early->samples[j];
                if (given.sample_count == 0 || !(given.samples[0].time_s <= kept.t_s)) {
                    host.samples.push_back(read_sample(kept));
                    host.samples.back().t_s = without_rounding_s(kept.t_s, end_s);
                }
            }
        }
        read_given(host, given, end_s, kind);
        input.samples = {host.samples.data() + first, host.samples.size() - first};
    }
}

void keep_early_samples(hh_world& host, double end_s) {
    for (std::size_t i = 0; i < host.inputs.size(); ++i) {
        const PlayerInput& input = host.inputs[i];
        const bool has_later =
            std::any_of(input.samples.begin(), input.samples.end(),
                        [&](const TrackingSample& sample) { return sample.t_s > end_s; });
        if (!has_later || host.repeats_samples[i] != 0) {
            host.world.early_samples.remove(input.player);
            continue;
        }
        EarlySamples kept;
        for (const TrackingSample& sample : input.samples) {
            if (!(sample.t_s > end_s)) {
                continue;
            }
            if (kept.count == EarlySamples::k_capacity) {
                ++host.samples_too_far_ahead;
                continue;
            }
            kept.samples[kept.count++] = early_of(sample);
        }
        EarlySamples* const before = host.world.early_samples.find(input.player);
        if (before != nullptr) {
            *before = kept;
        } else {
            host.world.early_samples.add(input.player, kept);
        }
    }
}

}  // namespace handhold
