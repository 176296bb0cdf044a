// Worlds of the C interface: making, stepping, saving (handhold/world.h).
#include "systems/host/host_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {
namespace {

constexpr double k_min_step_s = 1e-6;
constexpr double k_max_step_s = 10.0;

// Poses that are not tracked, or that no tracking gives, become NaN: read_tracking ignores them.
Pose tracked_or_invalid(const Pose& pose, bool is_tracked) {
    Pose read;
    if (is_tracked && is_valid(pose) &&
        pose.position.cwiseAbs().maxCoeff() < k_farthest_tracked_m) {
        return pose;
    }
    read.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    return read;
}

// A host that computes a step's end in another way than the world's clock, such as by dividing a
// frame's number, differs from it by rounding: such a sample is one of the step's end.
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

PlayerCommands read_commands(const hh_commands& commands) {
    return {commands.smooth_turn, commands.snap_turns, commands.brake, from_c(commands.thrust),
            commands.calibrate != 0};
}

// Elements of an array of definitions lie apart by the size that the host knows.
template <typename Def>
const Def& def_at(const Def* defs, std::size_t i) {
    return sized_element(defs, defs->struct_size, i);
}

// Element `i` of such an array. HH_ERROR_VERSION unless it has the size of the first.
template <typename Def>
Def read_def_at(const Def* defs, std::size_t i, const Def& defaults) {
    require(def_at(defs, i).struct_size == defs->struct_size, HH_ERROR_VERSION,
            "the elements of an array have different struct_size");
    return read_def(&def_at(defs, i), defaults);
}

// Players whose kept samples are due in a step that the host has no input for.
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

// A player all of whose samples are far from the step is stamped by another clock: said once.
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

// Appends the samples given for a player, but for those too far ahead. In a pause, in which the
// world's clock stands still, samples count whatever their time.
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

void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count,
                 StepKind kind) {
    checked(dt_s, k_min_step_s, k_max_step_s, "dt_s must lie in [1e-6, 10]");
    require(count == 0 || inputs != nullptr, HH_ERROR_NULL, "the inputs are null");
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

void finish_step(hh_world& host) {
    host.stats.fallbacks[static_cast<std::size_t>(Fallback::surface_answer_invalid)] +=
        host.surfaces.take_refused();
    const auto count = [&](Fallback reason, std::uint64_t times) {
        host.stats.fallbacks[static_cast<std::size_t>(reason)] += times;
    };
    count(Fallback::sample_too_far_ahead, host.samples_too_far_ahead);
    count(Fallback::sample_too_old, host.samples_too_old);
    host.samples_too_far_ahead = host.samples_too_old = 0;
    if (host.may_recycle_shapes) {  // the frame has run without the removed ones
        host.shapes.recycle_removed();
        host.may_recycle_shapes = false;
    }
}

// Lists the free bodies that hands hold in this frame, directly or through joints; sorted by id.
void note_held_bodies(hh_world& host) {
    const FrameGraph& frame = host.caches.graph;
    host.held_bodies.clear();
    for (std::size_t i = 0; i < std::min(frame.entities.size(), frame.phase.size()); ++i) {
        const RigidBody* const body = host.world.body.find(frame.entities[i]);
        if (frame.phase[i].held && body != nullptr && body->kind == BodyKind::free) {
            host.held_bodies.push_back(frame.entities[i]);
        }
    }
}

hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    HostStep step, bool makes_events) {
    hh_result result = call([&] {
        require_idle(world_of(world));
        read_inputs(*world, dt_s, inputs, count,
                    makes_events ? StepKind::advances : StepKind::poses_only);
    });
    if (result != HH_OK) {
        return result;
    }
    // All host errors have been checked before: an exception from here on is a defect of the
    // library.
    return call(
        [&] {
            hh_world& host = *world;
            host.velocity_changes.clear();
            begin_events(host);
            if (makes_events) {
                keep_early_samples(host, host.world.clock.t_s + dt_s);
            }
            step(host.world, host.caches, host.tuning, {dt_s, host.inputs}, host.stats);
            if (makes_events) {
                finish_events(host);
            }
            if (step == &step_frame) {
                note_held_bodies(host);
            }
            finish_step(host);
        },
        HH_ERROR_INTERNAL);
}

namespace {

const SnapshotAssets& assets_of(hh_world& host) {
    if (!host.assets || host.assets_revision != host.shapes.revision()) {
        std::vector<Pose> frames;
        for (const HostShape& shape : host.host_shapes) {
            frames.push_back(shape.frame);
        }
        host.assets.emplace(host.shapes, std::string_view{},
                            SnapshotAssets::OfHost{frames, host.head_shapes});
        host.assets_revision = host.shapes.revision();
    }
    return *host.assets;
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_default_world_def_sized(hh_world_def* filled, size_t size) {
    hh_world_def def{};
    def.fits_hands = true;
    def.reports_touches = true;
    return write_default(filled, size, def);
}

hh_result hh_world_create(const hh_world_def* wanted, hh_world** world) {
    return call([&] {
        require(world != nullptr, HH_ERROR_NULL, "the output is null");
        const hh_world_def defaults = hh_default_world_def();
        const hh_world_def def = wanted != nullptr ? read_def(wanted, defaults) : defaults;
        auto made = std::make_unique<hh_world>(def);
        made->world.gravity_mps2 = checked(def.gravity_mps2, world_limits::k_max_gravity_mps2,
                                           "a gravity beyond 1e4 m/s^2, or NaN");
        made->world.reference_velocity_mps =
            checked(def.reference_velocity_mps, world_limits::k_max_speed_mps,
                    "a reference velocity beyond 1e6 m/s, or NaN");
        *world = made.release();
    });
}

void hh_world_destroy(hh_world* world) {
    if (world != nullptr && world->surfaces.is_asking()) {
        report_failure(HH_ERROR_STATE, "a world cannot be destroyed inside its own surface query");
        return;
    }
    delete world;
}

hh_result hh_default_tracking_sample_sized(hh_tracking_sample* filled, size_t size) {
    hh_tracking_sample sample{};
    sample.head = sample.hands[0] = sample.hands[1] = hh_identity_pose();
    sample.head_tracked = sample.hand_tracked[0] = sample.hand_tracked[1] = true;
    for (hh_finger_curls& curls : sample.curls) {
        std::ranges::fill(curls.fingers, k_unknown_curl);
    }
    return write_default(filled, size, sample);
}

hh_result hh_default_player_input_sized(hh_player_input* filled, size_t size) {
    hh_player_input input{};
    return write_default(filled, size, input);
}

hh_result hh_world_step(hh_world* world, double dt_s, const hh_player_input* inputs,
                        size_t input_count) {
    return step_with(world, dt_s, inputs, input_count, &step_frame, true);
}

hh_result hh_world_step_pose_only(hh_world* world, double dt_s, const hh_player_input* inputs,
                                  size_t input_count) {
    return step_with(world, dt_s, inputs, input_count, &step_pose_only, false);
}

hh_result hh_world_time(const hh_world* world, double* time_s, uint64_t* frame) {
    return call([&] {
        const FrameClock& clock = world_of(world).world.clock;
        if (time_s != nullptr) {
            *time_s = clock.t_s;
        }
        if (frame != nullptr) {
            *frame = clock.frame;
        }
    });
}

hh_result hh_world_set_gravity(hh_world* world, hh_vec3 gravity_mps2) {
    return call([&] {
        World& state = world_of(world).world;
        state.gravity_mps2 = checked(gravity_mps2, world_limits::k_max_gravity_mps2,
                                     "a gravity beyond 1e4 m/s^2, or NaN");
    });
}

hh_result hh_world_set_reference_velocity(hh_world* world, hh_vec3 velocity_mps) {
    return call([&] {
        World& state = world_of(world).world;
        state.reference_velocity_mps = checked(velocity_mps, world_limits::k_max_speed_mps,
                                               "a reference velocity beyond 1e6 m/s, or NaN");
    });
}

hh_result hh_world_gravity(const hh_world* world, hh_vec3* gravity_mps2) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(gravity_mps2 != nullptr, HH_ERROR_NULL, "the output is null");
        *gravity_mps2 = to_c(host.world.gravity_mps2);
    });
}

hh_result hh_world_reference_velocity(const hh_world* world, hh_vec3* velocity_mps) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(velocity_mps != nullptr, HH_ERROR_NULL, "the output is null");
        *velocity_mps = to_c(host.world.reference_velocity_mps);
    });
}

hh_result hh_world_hash(const hh_world* world, uint64_t* hash) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(hash != nullptr, HH_ERROR_NULL, "the output is null");
        *hash = hash_state(host.world);
    });
}

hh_result hh_world_save(hh_world* world, void* buffer, size_t capacity, size_t* size) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        require(size != nullptr, HH_ERROR_NULL, "the size is null");
        save_snapshot(host.world, assets_of(host), host.snapshot);
        *size = host.snapshot.size();
        if (buffer != nullptr) {
            require(host.snapshot.size() <= capacity, HH_ERROR_CAPACITY, "the buffer is too small");
            std::memcpy(buffer, host.snapshot.data(), host.snapshot.size());
        }
    });
}

hh_result hh_world_restore(hh_world* world, const void* bytes, size_t size) {
    return call([&] {
        hh_world& host = world_of(world);
        require(bytes != nullptr, HH_ERROR_NULL, "the bytes are null");
        const std::span<const std::byte> read{static_cast<const std::byte*>(bytes), size};
        for (const double radius_m : head_radii_in(read, assets_of(host))) {
            if (radius_m >= k_smallest_head_m && radius_m <= k_largest_head_m) {
                head_shape(host, radius_m);  // heads have the sizes of the world that was saved
            }
        }
        if (const auto error = restore_snapshot(read, assets_of(host), host.world)) {
            throw HostError{HH_ERROR_DATA, error->message()};
        }
        sync_index(host.world);
        host.is_stepping = false;
        host.hand_constraints.clear();
        host.player_motions.clear();
        host.velocity_changes.clear();
        host.held_bodies.clear();
        forget_events(host);
    });
}
