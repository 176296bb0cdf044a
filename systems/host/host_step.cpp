// Worlds of the C interface: making, stepping, saving (handhold/world.h).
#include "systems/host/host_step.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

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
// frame's number, differs from it by rounding.
TrackingSample read_sample(const hh_tracking_sample& sample, double end_s, bool is_exact) {
    const double rounding_s = is_exact ? 0.0 : 1e-6;
    const bool is_at_end = sample.time_s > end_s && sample.time_s <= end_s + rounding_s;
    TrackingSample read;
    read.t_s = is_at_end ? end_s : sample.time_s;
    read.head_ps = tracked_or_invalid(unchecked_pose(sample.head), sample.head_tracked);
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        read.controllers[i].controller_ps =
            tracked_or_invalid(unchecked_pose(sample.hands[i]), sample.hand_tracked[i]);
        read.controllers[i].grab = sample.grab[i];
        read.controllers[i].squeeze = sample.squeeze[i];
        read.controllers[i].trigger = sample.trigger[i];
    }
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
    }
    return read;
}

EarlySample early_of(const TrackingSample& sample) {
    EarlySample early;
    early.t_s = sample.t_s;
    early.head_tracked = is_valid(sample.head_ps);
    early.head_ps = early.head_tracked ? sample.head_ps : Pose{};
    for (std::size_t i = 0; i < k_hand_count; ++i) {
        const Pose& controller_ps = sample.controllers[i].controller_ps;
        early.tracked[i] = is_valid(controller_ps);
        early.controllers_ps[i] = early.tracked[i] ? controller_ps : Pose{};
        early.grab[i] = sample.controllers[i].grab;
        early.squeeze[i] = pressed_share(sample.controllers[i].squeeze);
        early.trigger[i] = pressed_share(sample.controllers[i].trigger);
    }
    return early;
}

PlayerCommands read_commands(const hh_commands& commands) {
    return {commands.smooth_turn, commands.snap_turns, commands.brake, from_c(commands.thrust),
            commands.calibrate};
}

// Elements of an array of definitions lie apart by the size that the host knows.
const hh_player_input& input_at(const hh_player_input* inputs, std::size_t i) {
    const char* const bytes = reinterpret_cast<const char*>(inputs);
    return *reinterpret_cast<const hh_player_input*>(bytes + i * inputs->struct_size);
}

// Of any version: `repeats_samples` came after the first.
hh_player_input read_input(const hh_player_input* inputs, std::size_t i) {
    return read_def(&input_at(inputs, i), hh_default_player_input(),
                    offsetof(hh_player_input, repeats_samples));
}

}  // namespace

void read_inputs(hh_world& host, double dt_s, const hh_player_input* inputs, std::size_t count) {
    checked(dt_s, k_min_step_s, k_max_step_s, "dt_s must lie in [1e-6, 10]");
    require(count == 0 || inputs != nullptr, HH_ERROR_NULL, "the inputs are null");
    host.inputs.clear();
    host.repeats_samples.clear();
    host.samples.clear();
    std::size_t sample_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const hh_player_input input = read_input(inputs, i);
        require(input.sample_count == 0 || input.samples != nullptr, HH_ERROR_NULL,
                "an input's samples are null");
        constexpr std::size_t k_max_samples = 1U << 16U;
        require(input.sample_count <= k_max_samples, HH_ERROR_VALUE,
                "an input has more than 2^16 samples");
        const Entity player = player_of(host, input.player);
        for (const PlayerInput& other : host.inputs) {
            require(other.player != player, HH_ERROR_VALUE, "a player has two inputs");
        }
        host.inputs.push_back({player, {}, read_commands(input.commands)});
        host.repeats_samples.push_back(input.repeats_samples ? 1 : 0);
        sample_count += input.sample_count;
    }
    const double end_s = host.world.clock.t_s + dt_s;
    host.samples.reserve(sample_count + count);  // spans into it must not move
    for (std::size_t i = 0; i < count; ++i) {
        const hh_player_input input = read_input(inputs, i);
        const std::size_t first = host.samples.size();
        const EarlySample* const early = host.world.early_sample.find(host.inputs[i].player);
        if (early != nullptr && (input.sample_count == 0 || input.samples[0].time_s > early->t_s)) {
            host.samples.push_back(read_sample(*early));
        }
        for (std::size_t j = 0; j < input.sample_count; ++j) {
            host.samples.push_back(read_sample(input.samples[j], end_s, input.repeats_samples));
        }
        host.inputs[i].samples = {host.samples.data() + first, host.samples.size() - first};
    }
}

void keep_early_samples(hh_world& host, double end_s) {
    for (std::size_t i = 0; i < host.inputs.size(); ++i) {
        const PlayerInput& input = host.inputs[i];
        host.world.early_sample.remove(input.player);
        if (host.repeats_samples[i] != 0) {
            continue;
        }
        for (const TrackingSample& sample : input.samples) {
            if (sample.t_s > end_s && sample.t_s <= k_latest_s) {
                host.world.early_sample.add(input.player, early_of(sample));
                break;
            }
        }
    }
}

void finish_step(hh_world& host) {
    host.stats.fallbacks[static_cast<std::size_t>(Fallback::surface_answer_invalid)] +=
        host.surfaces.take_refused();
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
        read_inputs(*world, dt_s, inputs, count);
    });
    if (result != HH_OK) {
        return result;
    }
    // All that a host can do wrong has been checked: what is thrown now is a defect.
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
        host.assets.emplace(host.shapes);
        host.assets_revision = host.shapes.revision();
    }
    return *host.assets;
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_world_def hh_default_world_def(void) {
    hh_world_def def{};
    def.struct_size = sizeof def;
    def.fits_hands = true;
    def.reports_touches = true;
    return def;
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

hh_tracking_sample hh_default_tracking_sample(void) {
    hh_tracking_sample sample{};
    sample.head = sample.hands[0] = sample.hands[1] = hh_identity_pose();
    sample.head_tracked = sample.hand_tracked[0] = sample.hand_tracked[1] = true;
    return sample;
}

hh_player_input hh_default_player_input(void) {
    hh_player_input input{};
    input.struct_size = sizeof input;
    return input;
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
