// Every function of the C interface with null pointers, ids that find nothing, NaN, infinities and
// sizes of other versions: result codes, never a crash, and a world that still steps.
#include "misuse.hpp"

#include <cstdint>
#include <cstdio>
#include <vector>

#include <handhold/handhold.h>

namespace {

using namespace misuse;

void misuse_pointers(hh_world* world, hh_body body, hh_player player, hh_joint joint) {
    HH_GIVES(HH_ERROR_NULL, hh_world_create(nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_step(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_step(world, 0.01, nullptr, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_step_pose_only(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_time(nullptr, nullptr, nullptr));
    HH_GIVES(HH_OK, hh_world_time(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_gravity(nullptr, {}));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_reference_velocity(nullptr, {}));
    HH_GIVES(HH_ERROR_NULL, hh_world_hash(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_save(world, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_restore(world, nullptr, 10));
    HH_GIVES(HH_ERROR_NULL, hh_world_get_stats(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_stage_times(world, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_fallbacks(nullptr, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_tuning_describe(0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_get_tuning(world, "hand.reach_m", nullptr, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_tuning(world, nullptr, nullptr, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_tuning_numbers(world, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_tuning_numbers(world, nullptr, 5));
    HH_GIVES(HH_ERROR_NULL, hh_world_load_tuning(world, nullptr, 5));
    HH_GIVES(HH_ERROR_NULL, hh_world_load_body_clips(nullptr, "{}", 2));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_box(world, {1, 1, 1}, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_sphere(nullptr, 1.0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_capsule(world, 1.0, 1.0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_cylinder(world, 1.0, 1.0, nullptr));
    hh_shape shape{};
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_hull(world, nullptr, 8, &shape));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_compound(world, nullptr, 1, &shape));
    HH_GIVES(HH_ERROR_NULL, hh_shape_add_mesh(world, nullptr, {1, 1, 1}, &shape));
    HH_GIVES(HH_ERROR_NULL, hh_mesh_create(nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_shape_remove(nullptr, shape));
    HH_GIVES(HH_ERROR_NULL, hh_world_shape_count(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_add(world, nullptr, &body));
    HH_GIVES(HH_ERROR_NULL, hh_body_find(world, nullptr, &body));
    HH_GIVES(HH_ERROR_NULL, hh_body_name(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_bodies(world, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_pose(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_body_poses(world, nullptr, 3, nullptr));
    HH_GIVES(HH_OK, hh_body_velocity(world, body, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_user_data(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_add_grip(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_joint_add(world, nullptr, &joint));
    HH_GIVES(HH_OK, hh_joint_state(world, joint, nullptr, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_add(world, nullptr, &player));
    HH_GIVES(HH_ERROR_NULL, hh_world_players(world, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_velocity(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_measures(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_set_measures(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_user_data(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_hand_in_controller(world, player, HH_LEFT, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_hand(world, player, HH_LEFT, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_player_poses(world, nullptr, 1, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_events(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_hand_joints(world, player, HH_LEFT, HH_SPACE_WORLD, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_body_joints(world, player, HH_SPACE_WORLD, nullptr));
    HH_GIVES(HH_OK, hh_player_set_hand_rig(world, player, HH_LEFT, nullptr, 0));
    HH_GIVES(HH_OK, hh_player_set_body_rig(world, player, nullptr, 0));
    hh_hit hit{};
    hh_vec3 v{};
    HH_GIVES(HH_ERROR_NULL, hh_world_gravity(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_gravity(nullptr, &v));
    HH_GIVES(HH_ERROR_NULL, hh_world_reference_velocity(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_hand_in_controller(world, HH_LEFT, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_cast_ray(world, {}, {}, {}, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_cast_ray(nullptr, {}, {}, {}, &hit));
    HH_GIVES(HH_ERROR_NULL, hh_world_cast_sphere(world, 1.0, {}, {}, {}, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_closest_point(world, {}, 1.0, {}, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_overlap_sphere(world, {}, 1.0, {}, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_get_kind(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_mass(world, body, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_body_joints(world, body, nullptr, 0, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_reference_velocity(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_push_back(world, player, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_player_mass(world, player, nullptr));
    HH_GIVES(HH_OK, hh_player_head(world, player, nullptr, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_hand_moves_player(world, player, HH_LEFT, nullptr));
    HH_GIVES(HH_ERROR_VALUE, hh_set_thread_count(0));
    hh_sin_cos(1.0, nullptr, nullptr);
    hh_world_destroy(nullptr);
    hh_mesh_destroy(nullptr);
    hh_version(nullptr, nullptr, nullptr);
}

void misuse_ids(hh_world* world, std::uint32_t index, std::uint32_t generation) {
    const hh_body body{index, generation};
    const hh_player player{index, generation};
    const hh_joint joint{index, generation};
    const hh_shape shape{index, generation};
    hh_pose pose{};
    hh_vec3 v{};
    std::uint64_t number = 0;
    const char* name = nullptr;
    HH_GIVES(HH_ERROR_HANDLE, hh_body_remove(world, body));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_pose(world, body, &pose));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_name(world, body, &name));
    HH_GIVES(HH_ERROR_HANDLE, hh_world_body_poses(world, &body, 1, &pose));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_velocity(world, body, &v, &v));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_velocity(world, body, {}, {}));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_apply_impulse(world, body, {}, {}));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_teleport(world, body, k_origin));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_move_kinematic(world, body, k_origin));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_gravity_scale(world, body, 1.0));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_layers(world, body, 1, 1));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_grab_rule(world, body, true, true, false, 0));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_set_user_data(world, body, 1));
    HH_GIVES(HH_ERROR_HANDLE, hh_body_user_data(world, body, &number));
    hh_body_kind kind{};
    HH_GIVES(HH_ERROR_HANDLE, hh_body_get_kind(world, body, &kind));
    double mass_kg = 0.0;
    HH_GIVES(HH_ERROR_HANDLE, hh_body_mass(world, body, &mass_kg));
    size_t joint_count = 0;
    HH_GIVES(HH_ERROR_HANDLE, hh_body_joints(world, body, nullptr, 0, &joint_count));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_reference_velocity(world, player, &v));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_head(world, player, &v, nullptr, nullptr));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_push_back(world, player, &mass_kg));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_mass(world, player, &mass_kg));
    std::uint8_t moves_player = 0;
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_moves_player(world, player, HH_LEFT, &moves_player));
    if (generation != 0) {  // a null player: none is skipped
        hh_hit hit{};
        HH_GIVES(HH_ERROR_HANDLE, hh_world_cast_ray(world, {}, {1, 0, 0}, player, &hit));
        HH_GIVES(HH_ERROR_HANDLE, hh_world_closest_point(world, {}, 1.0, player, &hit));
    }
    const hh_grip_def grip = hh_default_grip_def();
    HH_GIVES(HH_ERROR_HANDLE, hh_body_add_grip(world, body, &grip));
    HH_GIVES(HH_ERROR_HANDLE, hh_joint_remove(world, joint));
    HH_GIVES(HH_ERROR_HANDLE, hh_joint_state(world, joint, nullptr, nullptr, nullptr));
    HH_GIVES(HH_ERROR_HANDLE, hh_shape_remove(world, shape));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_remove(world, player));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_teleport(world, player, k_origin));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_velocity(world, player, &v));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_velocity(world, player, {}));
    hh_measures measures{};
    HH_GIVES(HH_ERROR_HANDLE, hh_player_measures(world, player, &measures));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_measures(world, player, &measures));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_user_data(world, player, 1));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_user_data(world, player, &number));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_hand_in_controller(world, player, HH_LEFT, &k_origin));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_hand_in_controller(world, player, HH_LEFT, &pose));
    hh_hand_state hand{};
    HH_GIVES(HH_ERROR_HANDLE, hh_player_hand(world, player, HH_LEFT, &hand));
    hh_player_pose player_pose{};
    HH_GIVES(HH_ERROR_HANDLE, hh_world_player_poses(world, &player, 1, &player_pose));
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_grip(world, player, HH_LEFT, body));
    HH_GIVES(HH_ERROR_HANDLE, hh_hand_release(world, player, HH_LEFT));
    hh_hand_joint joints[HH_HAND_JOINT_COUNT];
    HH_GIVES(HH_ERROR_HANDLE,
             hh_player_hand_joints(world, player, HH_LEFT, HH_SPACE_WORLD, joints));
    hh_pose bones[HH_BODY_JOINT_COUNT];
    HH_GIVES(HH_ERROR_HANDLE, hh_player_body_joints(world, player, HH_SPACE_WORLD, bones));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_hand_rig(world, player, HH_LEFT, "x", 1));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_set_body_rig(world, player, "x", 1));
    size_t count = 0;
    HH_GIVES(HH_ERROR_HANDLE,
             hh_player_skeleton(world, player, HH_SPACE_WORLD, nullptr, 0, &count));
    HH_GIVES(HH_ERROR_HANDLE, hh_player_skeleton_joint(world, player, 0, nullptr, nullptr));
    hh_player_input input = hh_default_player_input();
    input.player = player;
    HH_GIVES(HH_ERROR_HANDLE, hh_world_step(world, 0.01, &input, 1));
    hh_joint_def hinge = hh_default_joint_def();
    hinge.body_b = body;
    hh_joint made{};
    HH_GIVES(HH_ERROR_HANDLE, hh_joint_add(world, &hinge, &made));
    hh_body_def def = hh_default_body_def();
    def.shape = shape;
    hh_body added{};
    if (generation != 0) {  // a null shape is none
        HH_GIVES(HH_ERROR_HANDLE, hh_body_add(world, &def, &added));
    }
    expect(!hh_body_is_valid(world, body) && !hh_player_is_valid(world, player) &&
               !hh_joint_is_valid(world, joint) && !hh_shape_is_valid(world, shape),
           "an id that finds nothing is valid", __LINE__);
}

void misuse_versions(hh_world* world) {
    hh_world* other = nullptr;
    hh_shape shape{};
    hh_body body{};
    hh_joint joint{};
    hh_player player{};
    hh_mesh* mesh = nullptr;
    for (const std::uint32_t size : {0U, 1U, 8U, 100000U}) {
        hh_world_def world_def = hh_default_world_def();
        hh_body_def body_def = hh_default_body_def();
        hh_joint_def joint_def = hh_default_joint_def();
        hh_player_def player_def = hh_default_player_def();
        hh_mesh_def mesh_def = hh_default_mesh_def();
        hh_world_stats stats = hh_default_world_stats();
        hh_tuning_info info = hh_default_tuning_info();
        hh_host_hooks hooks = hh_default_host_hooks();
        hh_player_input input = hh_default_player_input();
        world_def.struct_size = body_def.struct_size = joint_def.struct_size = size;
        player_def.struct_size = mesh_def.struct_size = stats.struct_size = size;
        info.struct_size = hooks.struct_size = input.struct_size = size;
        HH_GIVES(HH_ERROR_VERSION, hh_world_create(&world_def, &other));
        HH_GIVES(HH_ERROR_VERSION, hh_body_add(world, &body_def, &body));
        HH_GIVES(HH_ERROR_VERSION, hh_joint_add(world, &joint_def, &joint));
        HH_GIVES(HH_ERROR_VERSION, hh_player_add(world, &player_def, &player));
        HH_GIVES(HH_ERROR_VERSION, hh_mesh_create(&mesh_def, &mesh));
        HH_GIVES(HH_ERROR_VERSION, hh_world_get_stats(world, &stats));
        HH_GIVES(HH_ERROR_VERSION, hh_tuning_describe(0, &info));
        HH_GIVES(HH_ERROR_VERSION, hh_set_host_hooks(&hooks));
        HH_GIVES(HH_ERROR_VERSION, hh_world_step(world, 0.01, &input, 1));
        hh_tracking_sample sample = hh_default_tracking_sample();
        hh_player_input sampled = hh_default_player_input();
        sample.struct_size = size;
        sampled.samples = &sample;
        sampled.sample_count = 1;
        HH_GIVES(HH_ERROR_VERSION, hh_world_step(world, 0.01, &sampled, 1));
        const hh_event* events = nullptr;
        size_t count = 0;
        HH_GIVES(HH_ERROR_VERSION, hh_world_events_sized(world, &events, &count, size));
        hh_hand_state hand{};
        HH_GIVES(HH_ERROR_VERSION, hh_player_hand_sized(world, player, HH_LEFT, &hand, size));
        HH_GIVES(HH_ERROR_VERSION, hh_default_tracking_sample_sized(&sample, size > 8 ? 0 : size));
    }
    HH_GIVES(HH_ERROR_STATE, hh_set_host_hooks(nullptr));
    HH_GIVES(HH_ERROR_HANDLE, hh_shape_remove(world, shape));
    expect(other == nullptr && mesh == nullptr && body.generation == 0, "an output was written",
           __LINE__);
}

// Numbers of any kind in every place that takes one. The call may succeed; the world must go on.
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

}  // namespace

int main() {
    hh_world* world = nullptr;
    HH_GIVES(HH_OK, hh_world_create(nullptr, &world));
    hh_body_def def = hh_default_body_def();
    HH_GIVES(HH_OK, hh_shape_add_box(world, {0.1, 0.1, 0.1}, &def.shape));
    hh_body wall{};
    hh_body crate{};
    hh_body lift{};
    HH_GIVES(HH_OK, hh_body_add(world, &def, &wall));
    def.kind = HH_DYNAMIC;
    def.pose.position.x = 3.0;
    HH_GIVES(HH_OK, hh_body_add(world, &def, &crate));
    def.kind = HH_KINEMATIC;
    def.pose.position.x = 6.0;
    HH_GIVES(HH_OK, hh_body_add(world, &def, &lift));
    hh_joint_def joint_def = hh_default_joint_def();
    joint_def.kind = HH_HINGE;
    joint_def.body_b = crate;
    hh_joint joint{};
    HH_GIVES(HH_OK, hh_joint_add(world, &joint_def, &joint));
    const hh_player_def player_def = hh_default_player_def();
    hh_player player{};
    HH_GIVES(HH_OK, hh_player_add(world, &player_def, &player));
    HH_GIVES(HH_ERROR_STATE, hh_shape_remove(world, def.shape));

    misuse_pointers(world, crate, player, joint);
    for (const std::uint32_t index : {0U, 1U, 2U, 5U, 1000U, 0xffffffffU}) {
        misuse_ids(world, index, 0);
        misuse_ids(world, index, 77);
        misuse_ids(world, index, 0xffffffffU);
    }
    misuse_versions(world);
    Rng rng;
    for (int round = 0; round < 300; ++round) {
        misuse_numbers(world, crate, lift, player, rng);
        step_with_anything(world, player, rng);
    }
    damage_snapshots(world, rng);
    hh_world_destroy(world);
    std::printf("%d calls, %d wrong\n", g_calls, g_failures);
    return g_failures == 0 ? 0 : 1;
}
