// Every function of the C interface with null pointers, ids that find nothing, sizes of other
// versions, NaN and infinities (misuse_numbers.hpp): result codes, never a crash, and a world that
// still steps.
#include "misuse.hpp"

#include <cstdint>
#include <cstdio>
#include <initializer_list>

#include <handhold/handhold.h>

#include "misuse_numbers.hpp"

namespace {

using namespace misuse;

void misuse_pointers(hh_world* world, hh_body body, hh_player player, hh_joint joint) {
    HH_GIVES(HH_ERROR_NULL, hh_world_create(nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_step(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_step(world, 0.01, nullptr, 1));
    HH_GIVES(HH_ERROR_NULL, hh_world_step_pose_only(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_step_simulated(nullptr, 0.01, nullptr, 0));
    HH_GIVES(HH_ERROR_NULL, hh_world_time(nullptr, nullptr, nullptr));
    HH_GIVES(HH_OK, hh_world_time(world, nullptr, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_gravity(nullptr, {}));
    HH_GIVES(HH_ERROR_NULL, hh_world_set_reference_velocity(nullptr, {}));
    HH_GIVES(HH_ERROR_NULL, hh_world_hash(world, nullptr));
    HH_GIVES(HH_ERROR_NULL, hh_world_simulated_hash(world, nullptr));
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
