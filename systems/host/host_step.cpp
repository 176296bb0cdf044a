// Worlds of the C interface: making, stepping, saving (handhold/world.h).
#include "systems/host/host_step.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "systems/host/host_samples.hpp"

namespace handhold {

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

namespace {

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

}  // namespace

void run_step(hh_world& host, const FrameInput& input, const HostStep& step) {
    host.velocity_changes.clear();
    begin_events(host);
    host.shows_hands = step.shows_hands;
    step.run(host.world, host.caches, host.tuning, input, host.stats);
    if (step.advances) {
        finish_events(host);
    }
    if (step.moves_bodies) {
        note_held_bodies(host);
    }
    finish_step(host);
}

void require_no_match(const hh_world& host) {
    require(!host.is_in_match, HH_ERROR_STATE, "the world is in a match, which steps it");
}

hh_result step_with(hh_world* world, double dt_s, const hh_player_input* inputs, std::size_t count,
                    const HostStep& step) {
    hh_result result = call([&] {
        require_idle(world_of(world));
        require_no_match(*world);
        read_inputs(*world, dt_s, inputs, count,
                    step.advances ? StepKind::advances : StepKind::poses_only);
    });
    if (result != HH_OK) {
        return result;
    }
    // All host errors have been checked before: an exception from here on is a defect of the
    // library.
    return call(
        [&] {
            hh_world& host = *world;
            if (step.advances) {
                keep_early_samples(host, host.world.clock.t_s + dt_s);
            }
            run_step(host, {dt_s, host.inputs}, step);
        },
        HH_ERROR_INTERNAL);
}

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

MissingHeads missing_heads(hh_world& host) {
    return {.smallest_m = k_smallest_head_m,
            .largest_m = k_largest_head_m,
            .make = [&host](double radius_m) { return head_shape(host, radius_m); }};
}

void finish_restore(hh_world& host) {
    sync_index(host.world);
    host.is_stepping = false;
    host.hand_constraints.clear();
    host.player_motions.clear();
    host.velocity_changes.clear();
    host.held_bodies.clear();
    forget_events(host);
}

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
    if (world != nullptr && world->is_in_match) {
        report_failure(HH_ERROR_STATE, "a world cannot be destroyed while it is in a match");
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
    return step_with(world, dt_s, inputs, input_count, {.run = &step_frame});
}

hh_result hh_world_step_simulated(hh_world* world, double dt_s, const hh_player_input* inputs,
                                  size_t input_count) {
    return step_with(world, dt_s, inputs, input_count,
                     {.run = &step_simulated, .shows_hands = false});
}

hh_result hh_world_step_pose_only(hh_world* world, double dt_s, const hh_player_input* inputs,
                                  size_t input_count) {
    return step_with(world, dt_s, inputs, input_count,
                     {.run = &step_pose_only, .advances = false, .moves_bodies = false});
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

hh_result hh_world_simulated_hash(const hh_world* world, uint64_t* hash) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(hash != nullptr, HH_ERROR_NULL, "the output is null");
        *hash = hash_simulated(host.world);
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
        require_no_match(host);
        require(bytes != nullptr, HH_ERROR_NULL, "the bytes are null");
        const std::span<const std::byte> read{static_cast<const std::byte*>(bytes), size};
        // Heads have the sizes of the world that was saved.
        if (const auto error =
                restore_snapshot(read, assets_of(host), host.world, missing_heads(host))) {
            throw HostError{HH_ERROR_DATA, error->message()};
        }
        finish_restore(host);
    });
}
