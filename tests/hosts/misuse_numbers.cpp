// Numbers of any kind, in calls, steps and damaged snapshots.
#include "misuse_numbers.hpp"

#include <cstdint>
#include <vector>

namespace misuse {

void misuse_numbers(hh_world* world, hh_body body, hh_body kinematic, hh_player player, Rng& rng) {
    hh_shape shape{};
    (void)hh_world_set_gravity(world, rng.vector());
    (void)hh_world_set_gravity(world, {});
    HH_GIVES(HH_ERROR_VALUE, hh_world_set_gravity(world, {k_nan, 0, 0}));
    HH_GIVES(HH_ERROR_VALUE, hh_world_set_reference_velocity(world, {0, k_inf, 0}));
    HH_GIVES(HH_ERROR_VALUE, hh_world_step(world, k_nan, nullptr, 0));
    HH_GIVES(HH_ERROR_VALUE, hh_world_step(world, -1.0, nullptr, 0));
    HH_REFUSED(hh_shape_add_box(world, {k_nan, 1, 1}, &shape));
    HH_REFUSED(hh_shape_add_sphere(world, 0.0, &shape));
    HH_REFUSED(hh_shape_add_capsule(world, k_inf, 1.0, &shape));
    HH_REFUSED(hh_shape_add_cylinder(world, 1.0, k_nan, &shape));
    std::vector<hh_vec3> points(8);
    for (hh_vec3& point : points) {
        point = rng.vector();
    }
    (void)hh_shape_add_hull(world, points.data(), points.size(), &shape);
    hh_compound_part part{{}, rng.pose(), rng.number()};
    HH_REFUSED(hh_shape_add_compound(world, &part, 1, &shape));
    const float corner[9] = {0, 0, 0, 1, 0, 0, static_cast<float>(k_nan), 1, 0};
    const std::uint32_t indices[3] = {0, 1, static_cast<std::uint32_t>(rng.next())};
    hh_mesh_def mesh_def = hh_default_mesh_def();
    mesh_def.positions = corner;
    mesh_def.vertex_count = 3;
    mesh_def.indices = indices;
    mesh_def.index_count = 3;
    hh_mesh* mesh = nullptr;
    HH_REFUSED(hh_mesh_create(&mesh_def, &mesh));
    hh_body_def def = hh_default_body_def();
    def.kind = static_cast<hh_body_kind>(rng.next() % 5);
    def.pose = rng.next() % 2 == 0 ? k_origin : rng.pose();
    def.velocity_mps = rng.vector();
    def.mass_kg = rng.number();
    def.inertia_kgm2 = rng.vector();
    def.friction = rng.number();
    def.restitution = rng.number();
    def.gravity_scale = rng.number();
    hh_body made{};
    if (hh_body_add(world, &def, &made) == HH_OK) {
        HH_GIVES(HH_OK, hh_body_remove(world, made));
    }
    hh_joint_def joint_def = hh_default_joint_def();
    joint_def.kind = static_cast<hh_joint_kind>(rng.next() % 7);
    joint_def.body_b = body;
    joint_def.frame = rng.next() % 2 == 0 ? k_origin : rng.pose();
    joint_def.lower = rng.number();
    joint_def.upper = rng.number();
    joint_def.friction = rng.number();
    joint_def.detent_spacing = rng.number();
    joint_def.latch_range = rng.number();
    hh_joint joint{};
    if (hh_joint_add(world, &joint_def, &joint) == HH_OK) {
        HH_GIVES(HH_OK, hh_joint_remove(world, joint));
    }
    hh_hit hits[4];
    size_t hit_count = 0;
    (void)hh_world_cast_ray(world, rng.vector(), rng.vector(), player, hits);
    (void)hh_world_cast_sphere(world, rng.number(), rng.vector(), rng.vector(), {}, hits);
    (void)hh_world_closest_point(world, rng.vector(), rng.number(), {}, hits);
    (void)hh_world_overlap_sphere(world, rng.vector(), rng.number(), {}, hits, 4, &hit_count);
    HH_GIVES(HH_ERROR_VALUE, hh_world_cast_ray(world, {k_nan, 0, 0}, {}, {}, hits));
    HH_GIVES(HH_ERROR_VALUE, hh_world_closest_point(world, {}, k_inf, {}, hits));
    double sine = 0.0;
    hh_sin_cos(rng.number(), &sine, nullptr);
    const double angle = hh_atan2(rng.number(), rng.number());
    expect(sine >= -1.0 && sine <= 1.0 && angle >= -3.2 && angle <= 3.2, "no angle", __LINE__);
    (void)hh_body_set_velocity(world, body, rng.vector(), rng.vector());
    (void)hh_body_set_velocity(world, body, {}, {});
    (void)hh_body_apply_impulse(world, body, rng.vector(), rng.vector());
    (void)hh_body_teleport(world, body, rng.pose());
    (void)hh_body_move_kinematic(world, kinematic, rng.pose());
    HH_GIVES(HH_ERROR_STATE, hh_body_move_kinematic(world, body, k_origin));
    (void)hh_body_set_gravity_scale(world, body, rng.number());
    (void)hh_player_teleport(world, player, rng.pose());
    (void)hh_player_set_velocity(world, player, rng.vector());
    const hh_measures measures{rng.number(), rng.number(), rng.number(), rng.number()};
    (void)hh_player_set_measures(world, player, &measures);
    const hh_pose pose = rng.pose();
    (void)hh_player_set_hand_in_controller(world, player, HH_LEFT, &pose);
    (void)hh_player_set_hand_in_controller(world, player, HH_LEFT, nullptr);
    hh_hand_state hand{};
    HH_GIVES(HH_ERROR_VALUE, hh_player_hand(world, player, static_cast<hh_side>(7), &hand));
    hh_grip_def grip = hh_default_grip_def();
    grip.hands[0].is_used = true;
    grip.hands[0].wrist = rng.pose();
    grip.hands[0].fingers[1].is_posed = grip.hands[0].fingers[1].follows_trigger = true;
    grip.hands[0].fingers[1].pressed_curl_rad[0] = rng.number();
    grip.snap_radius_m = rng.number();
    (void)hh_body_add_grip(world, kinematic, &grip);
    const double value = rng.number();
    hh_tuning_info info = hh_default_tuning_info();
    if (hh_tuning_describe(rng.next() % 130, &info) == HH_OK) {
        const double old[3] = {info.low, info.low, info.low};
        double kept[3] = {};
        HH_GIVES(HH_OK, hh_world_get_tuning(world, info.name, kept, info.count));
        const double values[3] = {value, value, value};
        if (hh_world_set_tuning(world, info.name, values, info.count) == HH_OK) {
            HH_GIVES(HH_OK, hh_world_set_tuning(world, info.name, kept, info.count));
        }
        HH_GIVES(HH_ERROR_VALUE, hh_world_set_tuning(world, info.name, old, info.count + 1));
    }
    HH_GIVES(HH_ERROR_VALUE, hh_world_set_tuning_numbers(world, &value, 1));
    HH_GIVES(HH_ERROR_NAME, hh_world_set_tuning(world, "no.such", &value, 1));
    HH_GIVES(HH_ERROR_DATA, hh_world_load_tuning(world, "{\"hand\": 3}", 11));
    HH_GIVES(HH_ERROR_DATA, hh_world_load_body_clips(world, "{\"idle\": 3}", 11));
    HH_GIVES(HH_ERROR_DATA, hh_player_set_hand_rig(world, player, HH_LEFT, "glTF", 4));
    HH_GIVES(HH_ERROR_DATA, hh_player_set_body_rig(world, player, "{}", 2));
}

void step_with_anything(hh_world* world, hh_player player, Rng& rng) {
    hh_tracking_sample samples[3];
    for (hh_tracking_sample& sample : samples) {
        sample = hh_default_tracking_sample();
        sample.time_s = rng.next() % 2 == 0 ? rng.number() : 1e9 * rng.number();
        sample.head = rng.pose();
        sample.hands[rng.next() % 2] = rng.pose();
        sample.grab[rng.next() % 2] = rng.next() % 2 == 0;
    }
    hh_player_input input = hh_default_player_input();
    input.player = player;
    input.samples = samples;
    input.sample_count = 3;
    input.commands = {rng.number(), static_cast<int32_t>(rng.next()), rng.number(), rng.vector(),
                      rng.next() % 2 == 0};
    HH_GIVES(HH_OK, hh_world_step(world, 1.0 / 90.0, &input, 1));
    HH_GIVES(HH_OK, hh_world_step_pose_only(world, 1.0 / 90.0, &input, 1));
}

void damage_snapshots(hh_world* world, Rng& rng) {
    size_t size = 0;
    HH_GIVES(HH_OK, hh_world_save(world, nullptr, 0, &size));
    std::vector<unsigned char> bytes(size);
    HH_GIVES(HH_ERROR_CAPACITY, hh_world_save(world, bytes.data(), size - 1, &size));
    HH_GIVES(HH_OK, hh_world_save(world, bytes.data(), size, &size));
    std::uint64_t before = 0;
    std::uint64_t after = 0;
    HH_GIVES(HH_OK, hh_world_hash(world, &before));
    for (int i = 0; i < 200; ++i) {
        std::vector<unsigned char> damaged = bytes;
        damaged[rng.next() % size] ^= static_cast<unsigned char>(1U << (rng.next() % 8));
        HH_GIVES(HH_ERROR_DATA, hh_world_restore(world, damaged.data(), damaged.size()));
        HH_GIVES(HH_ERROR_DATA, hh_world_restore(world, bytes.data(), rng.next() % size));
    }
    HH_GIVES(HH_OK, hh_world_hash(world, &after));
    expect(before == after, "a refused snapshot changed the world", __LINE__);
    HH_GIVES(HH_OK, hh_world_restore(world, bytes.data(), bytes.size()));
}

}  // namespace misuse
