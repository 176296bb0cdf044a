/* A hand that grips a wall, without any C library: ends with status 0 if it does. For a linker that knows Microsoft's formats. */
#include <handhold/handhold.h>

__declspec(dllimport) void __stdcall ExitProcess(unsigned status);
int _fltused; /* Microsoft's compilers refer to it where numbers are floating */

static int grips(void) {
    hh_world* world = 0;
    if (hh_world_create(0, &world) != HH_OK) {
        return 0;
    }
    hh_body_def wall = hh_default_body_def();
    const hh_vec3 half = {2.0, 2.0, 0.1};
    hh_body wall_id;
    hh_player_def you = hh_default_player_def();
    hh_player_input input = hh_default_player_input();
    const hh_pose wrist = hh_identity_pose();
    hh_result worst = hh_shape_add_box(world, half, &wall.shape);
    wall.pose.position.y = 1.5;
    wall.pose.position.z = -0.6;
    worst |= hh_body_add(world, &wall, &wall_id);
    worst |= hh_player_add(world, &you, &input.player);
    worst |= hh_player_set_hand_in_controller(world, input.player, HH_LEFT, &wrist);
    worst |= hh_player_set_hand_in_controller(world, input.player, HH_RIGHT, &wrist);
    for (int frame = 1; frame <= 90; ++frame) {
        hh_tracking_sample sample = hh_default_tracking_sample();
        sample.time_s = frame / 90.0;
        sample.head.position.y = 1.6;
        for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
            sample.hands[side].position.x = side == HH_RIGHT ? 0.2 : -0.2;
            sample.hands[side].position.y = 1.4;
            sample.hands[side].position.z = -0.43;
            sample.hands[side].rotation.x = 0.70710678118654757;
            sample.hands[side].rotation.w = 0.70710678118654757;
        }
        sample.grab[HH_RIGHT] = frame >= 45;
        input.samples = &sample;
        input.sample_count = 1;
        worst |= hh_world_step(world, 1.0 / 90.0, &input, 1);
    }
    hh_player_pose pose;
    worst |= hh_world_player_poses(world, &input.player, 1, &pose);
    hh_world_destroy(world);
    return worst == HH_OK && pose.hands[HH_RIGHT].grip == HH_GRIP_SURFACE;
}

void start(void) { ExitProcess(grips() ? 0 : 1); }
