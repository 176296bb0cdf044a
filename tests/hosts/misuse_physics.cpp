// The functions for hosts with physics of their own, with null pointers, wrong ids, numbers of any
// kind, calls at the wrong time, and surfaces that answer anything: result codes, never a crash,
// and a world that still steps.
#include <cstdint>
#include <cstdio>
#include <vector>

#include <handhold/handhold.h>

#include "misuse.hpp"

namespace {

using namespace misuse;

struct Surfaces {
    Rng rng;
    std::vector<hh_body> bodies;
    std::uint64_t asked = 0;

    bool answer(hh_surface_hit* hit) {
        ++asked;
        hit->body = bodies[rng.next() % bodies.size()];
        if (rng.next() % 4 == 0) {
            hit->body = {static_cast<std::uint32_t>(rng.next()),
                         static_cast<std::uint32_t>(rng.next() % 3)};
        }
        hit->point = rng.vector();
        hit->normal = rng.vector();
        hit->distance_m = rng.number();
        return rng.next() % 3 != 0;
    }
};

hh_surface_query answers_anything(Surfaces& surfaces) {
    hh_surface_query query = hh_default_surface_query();
    query.context = &surfaces;
    query.cast_ray = [](void* context, hh_vec3, hh_vec3, const hh_body*, size_t,
                        hh_surface_hit* hit) -> std::uint8_t {
        return static_cast<Surfaces*>(context)->answer(hit);
    };
    query.cast_sphere = [](void* context, double, hh_vec3, hh_vec3, const hh_body*, size_t,
                           hh_surface_hit* hit) -> std::uint8_t {
        return static_cast<Surfaces*>(context)->answer(hit);
    };
    query.closest_point = [](void* context, hh_vec3, double, const hh_body*, size_t,
                             hh_surface_hit* hit) -> std::uint8_t {
        return static_cast<Surfaces*>(context)->answer(hit);
    };
    query.closest_point_on = [](void* context, hh_body, hh_vec3,
                                hh_surface_hit* hit) -> std::uint8_t {
        return static_cast<Surfaces*>(context)->answer(hit);
    };
    return query;
}

void misuse_pointers(hh_world* world, hh_body body, hh_player player) {
    HH_GIVES(HH_ERROR_NULL, hh_world_set_surface_query(nullptr, nullptr));
    HH_GIVES(HH_OK, hh_world_set_surface_query(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_set_surface(nullptr, body, nullptr));
    HH_GIVES(HH_OK, hh_body_set_surface(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_place_bodies(world, nullptr, 1));
    HH_GIVES(HH_OK, hh_world_place_bodies(world, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_player_place(nullptr, player, k_origin, {}));
    HH_GIVES(HH_ERROR_NULL, hh_hand_hold(nullptr, player, HH_LEFT, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_hand_find_grip(world, player, HH_LEFT, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_step_hands(world, 0.01, nullptr, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_begin_step(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_end_step(nullptr, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_hand_constraints(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_player_motions(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_velocity_changes(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_held_bodies(world, nullptr, 0, nullptr));
    hh_surface_query query = hh_default_surface_query();
    query.struct_size = 3;
    HH_GIVES(HH_ERROR_VERSION, hh_world_set_surface_query(world, &query));
}

void misuse_ids(hh_world* world, hh_player real, hh_body real_body, std::uint32_t index) {
    const hh_body body{index, 77};
    const hh_player player{index, 77};
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_surface(world, body, nullptr));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_place(world, player, k_origin, {}));
    hh_surface_hit hit{};
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_find_grip(world, player, HH_LEFT, &hit));
    HH_GIVES(HH_ERROR_STATE, hh_hand_find_grip(world, real, HH_LEFT, &hit));
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_hold(world, player, HH_LEFT, real_body, nullptr));
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_hold(world, real, HH_LEFT, body, nullptr));
    HH_GIVES(HH_ERROR_VALUE,
             hh_hand_hold(world, real, static_cast<hh_side>(5), real_body, nullptr));
    // The first motion is good, and must not be applied.
    hh_pose before{};
    hh_pose after{};
    HH_GIVES(HH_OK, hh_body_pose(world, real_body, &before));
    const hh_body_motion motions[2] = {{real_body, {{5.0, 5.0, 5.0}, {0, 0, 0, 1}}, {}, {}},
                                       {body, k_origin, {}, {}}};
    HH_GIVES(HH_ERROR_HANDLE, hh_world_place_bodies(world, motions, 2));
    HH_GIVES(HH_OK, hh_body_pose(world, real_body, &after));
    expect(before.position.x == after.position.x, "half a list was placed", __LINE__);
}

// Between begin and end: what would change what the step refers to.
void misuse_order(hh_world* world, hh_body body, hh_player player) {
    HH_GIVES(HH_ERROR_STATE, hh_world_end_step(world, nullptr, 0));
    HH_GIVES(HH_OK, hh_world_begin_step(world, 1.0 / 90.0, nullptr, 0));
    HH_GIVES(HH_ERROR_STATE, hh_world_begin_step(world, 1.0 / 90.0, nullptr, 0));
    HH_GIVES(HH_ERROR_STATE, hh_world_step(world, 1.0 / 90.0, nullptr, 0));
    HH_GIVES(HH_ERROR_STATE, hh_world_step_hands(world, 1.0 / 90.0, nullptr, 0));
    HH_GIVES(HH_ERROR_STATE, hh_world_step_pose_only(world, 1.0 / 90.0, nullptr, 0));
    HH_GIVES(HH_ERROR_STATE, hh_body_remove(world, body));
    HH_GIVES(HH_ERROR_STATE, hh_player_remove(world, player));
    HH_GIVES(HH_ERROR_STATE, hh_body_teleport(world, body, k_origin));
    HH_GIVES(HH_ERROR_STATE, hh_player_teleport(world, player, k_origin));
    HH_GIVES(HH_ERROR_STATE, hh_player_place(world, player, k_origin, {}));
    HH_GIVES(HH_ERROR_STATE, hh_hand_hold(world, player, HH_LEFT, body, nullptr));
    HH_GIVES(HH_ERROR_STATE, hh_world_set_surface_query(world, nullptr));
    const hh_body_def def = hh_default_body_def();
    hh_body added{};
    HH_GIVES(HH_ERROR_STATE, hh_body_add(world, &def, &added));
    size_t size = 0;
    HH_GIVES(HH_ERROR_STATE, hh_world_save(world, nullptr, 0, &size));
    const hh_solved_player twice[2] = {{player, {}, {}}, {player, {}, {}}};
    HH_GIVES(HH_ERROR_VALUE, hh_world_end_step(world, twice, 2));
    const hh_solved_player nowhere{player, {k_nan, 0, 0}, {}};
    HH_GIVES(HH_ERROR_VALUE, hh_world_end_step(world, &nowhere, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_end_step(world, nullptr, 1));
    HH_GIVES(HH_OK, hh_world_end_step(world, nullptr, 0));
}

// A body that sleeps in the host's engine is not placed, and must not fall in Handhold's world.
void let_sleep(hh_world* world, hh_body dynamic) {
    hh_pose before{};
    hh_pose after{};
    hh_vec3 velocity{};
    HH_GIVES(HH_OK, hh_world_set_gravity(world, {0.0, -10.0, 0.0}));
    HH_GIVES(HH_OK, hh_body_pose(world, dynamic, &before));
    for (int step = 0; step < 10; ++step) {
        HH_GIVES(HH_OK, hh_world_begin_step(world, 0.1, nullptr, 0));
        HH_GIVES(HH_OK, hh_world_end_step(world, nullptr, 0));
    }
    HH_GIVES(HH_OK, hh_body_pose(world, dynamic, &after));
    HH_GIVES(HH_OK, hh_body_velocity(world, dynamic, &velocity, nullptr));
    expect(before.position.y == after.position.y && velocity.y == 0.0, "a sleeping body fell",
           __LINE__);
    const hh_body_motion motion{dynamic, {{1.0, 2.0, 3.0}, {0, 0, 0, 1}}, {0.0, 1.0, 0.0}, {}};
    HH_GIVES(HH_OK, hh_world_begin_step(world, 0.1, nullptr, 0));
    HH_GIVES(HH_OK, hh_world_place_bodies(world, &motion, 1));
    HH_GIVES(HH_OK, hh_world_end_step(world, nullptr, 0));
    HH_GIVES(HH_OK, hh_body_pose(world, dynamic, &after));
    HH_GIVES(HH_OK, hh_body_velocity(world, dynamic, &velocity, nullptr));
    expect(after.position.y == 2.0 && velocity.y == 1.0, "a placed body is where the host put it",
           __LINE__);
    HH_GIVES(HH_OK, hh_world_set_gravity(world, {}));
}

void misuse_numbers(hh_world* world, const std::vector<hh_body>& bodies, hh_player player,
                    Rng& rng) {
    const hh_body body = bodies[rng.next() % bodies.size()];
    const hh_body_motion motion{body, rng.next() % 2 == 0 ? k_origin : rng.pose(), rng.vector(),
                                rng.vector()};
    (void)hh_world_place_bodies(world, &motion, 1);
    (void)hh_player_place(world, player, rng.next() % 2 == 0 ? k_origin : rng.pose(), rng.vector());
    const hh_pose anchor = rng.pose();
    (void)hh_hand_hold(world, player, HH_LEFT, body, &anchor);
    hh_surface_hit hit{};
    (void)hh_hand_find_grip(world, player, HH_RIGHT, &hit);
    hh_tracking_sample sample = hh_default_tracking_sample();
    hh_player_input input = hh_default_player_input();
    double now_s = 0.0;
    HH_GIVES(HH_OK, hh_world_time(world, &now_s, nullptr));
    sample.time_s = now_s + 0.01;
    sample.head.position.y = 1.6;
    sample.hands[0].position = {-0.2, 1.2, -0.3};
    sample.hands[1].position = {0.2, 1.2, -0.3};
    sample.grab[0] = rng.next() % 2 == 0;
    sample.grab[1] = rng.next() % 2 == 0;
    input.player = player;
    input.samples = &sample;
    input.sample_count = 1;
    switch (rng.next() % 3) {
        case 0:
            HH_GIVES(HH_OK, hh_world_step_hands(world, 0.01, &input, 1));
            return;
        case 1:
            HH_GIVES(HH_OK, hh_world_step(world, 0.01, &input, 1));
            return;
        default:
            break;
    }
    HH_GIVES(HH_OK, hh_world_begin_step(world, 0.01, &input, 1));
    (void)hh_world_place_bodies(world, &motion, 1);
    const hh_solved_player solved{player, rng.vector(), rng.vector()};
    if (hh_world_end_step(world, &solved, 1) != HH_OK) {
        HH_GIVES(HH_OK, hh_world_end_step(world, nullptr, 0));
    }
    const hh_velocity_change* changes = nullptr;
    size_t count = 0;
    HH_GIVES(HH_OK, hh_world_velocity_changes(world, &changes, &count));
}

}  // namespace

int main() {
    hh_world* world = nullptr;
    HH_GIVES(HH_OK, hh_world_create(nullptr, &world));
    Surfaces surfaces;
    hh_body_def def = hh_default_body_def();
    def.inertia_kgm2 = {0.1, 0.1, 0.1};
    for (const hh_body_kind kind : {HH_STATIC, HH_KINEMATIC, HH_DYNAMIC}) {
        def.kind = kind;
        def.pose.position.x += 1.0;
        hh_body body{};
        HH_GIVES(HH_OK, hh_body_add(world, &def, &body));
        surfaces.bodies.push_back(body);
    }
    const hh_player_def player_def = hh_default_player_def();
    hh_player player{};
    HH_GIVES(HH_OK, hh_player_add(world, &player_def, &player));
    HH_GIVES(HH_ERROR_STATE,
             hh_hand_hold(world, player, HH_LEFT, surfaces.bodies.front(), nullptr));

    misuse_pointers(world, surfaces.bodies.front(), player);
    for (const std::uint32_t index : {0U, 2U, 1000U, 0xffffffffU}) {
        misuse_ids(world, player, surfaces.bodies.front(), index);
    }
    misuse_order(world, surfaces.bodies.front(), player);
    let_sleep(world, surfaces.bodies.back());

    const hh_surface_query query = answers_anything(surfaces);
    HH_GIVES(HH_OK, hh_world_set_surface_query(world, &query));
    const double reach_m = 1.0;
    HH_GIVES(HH_OK, hh_world_set_tuning(world, "pull.reach_m", &reach_m, 1));
    std::uint64_t refused = 0;
    for (int round = 0; round < 2000; ++round) {
        misuse_numbers(world, surfaces.bodies, player, surfaces.rng);
        std::uint64_t fallbacks[256] = {};
        size_t count = 0;
        HH_GIVES(HH_OK, hh_world_fallbacks(world, fallbacks, 256, &count));
        refused += fallbacks[count - 1];  // surface_answer_invalid
    }
    expect(surfaces.asked > 100 && refused > 10, "the surfaces were not asked", __LINE__);
    hh_world_destroy(world);
    std::printf("%d calls, %llu answers of which %llu were ignored, %d wrong\n", g_calls,
                static_cast<unsigned long long>(surfaces.asked),
                static_cast<unsigned long long>(refused), g_failures);
    return g_failures == 0 ? 0 : 1;
}
