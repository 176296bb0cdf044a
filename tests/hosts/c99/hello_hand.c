/* A host in C99: a wall, a player whose right hand grips it and pulls, and what came of it. */
#include <math.h>
#include <stdio.h>

#include <handhold/handhold.h>

static int check(hh_result result) {
    if (result != HH_OK) fprintf(stderr, "%s: %s\n", hh_result_text(result), hh_last_error());
    return result == HH_OK;
}

/* The right palm faces the wall, closes at 0.5 s, and pulls by 0.2 m from 1 s to 1.5 s. */
static hh_tracking_sample devices_at(double t_s) {
    hh_tracking_sample sample = hh_default_tracking_sample();
    double pulled = 0.4 * (fmin(fmax(t_s, 1.0), 1.5) - 1.0);
    sample.time_s = t_s;
    sample.head.position.y = 1.6;
    for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
        sample.hands[side].position = (hh_vec3){side == HH_RIGHT ? 0.2 : -0.2, 1.4, -0.43};
        sample.hands[side].rotation = (hh_quat){sqrt(0.5), 0.0, 0.0, sqrt(0.5)};
    }
    sample.hands[HH_RIGHT].position.z += pulled;
    sample.grab[HH_RIGHT] = t_s >= 0.5;
    return sample;
}

int main(void) {
    hh_world* world = NULL;
    hh_shape box;
    hh_body wall;
    hh_player_input input = hh_default_player_input();
    hh_body_def wall_def = hh_default_body_def();
    hh_player_def player_def = hh_default_player_def();
    hh_pose wrist = hh_identity_pose(); /* our samples are wrists, not controllers */
    if (!check(hh_world_create(NULL, &world))) return 1;
    check(hh_shape_add_box(world, (hh_vec3){2.0, 2.0, 0.1}, &box));
    wall_def.shape = box;
    wall_def.pose.position = (hh_vec3){0.0, 1.5, -0.6};
    check(hh_body_add(world, &wall_def, &wall));
    check(hh_player_add(world, &player_def, &input.player));
    check(hh_player_set_hand_in_controller(world, input.player, HH_LEFT, &wrist));
    check(hh_player_set_hand_in_controller(world, input.player, HH_RIGHT, &wrist));
    for (int frame = 1; frame <= 180; ++frame) {
        hh_tracking_sample sample = devices_at(frame / 90.0);
        input.samples = &sample;
        input.sample_count = 1;
        if (!check(hh_world_step(world, 1.0 / 90.0, &input, 1))) return 1;
    }
    hh_player_pose pose;
    check(hh_world_player_poses(world, &input.player, 1, &pose));
    const hh_hand_state* hand = &pose.hands[HH_RIGHT];
    printf("grip %d of the wall: %d, error %.1e m, the player came %.4f m nearer\n", hand->grip,
           hand->body.index == wall.index, hand->error_m, -pose.origin.position.z);
    /* Closed form: a hand on a wall moves the player by as much as it moves towards the body. */
    int is_right = hand->grip == HH_GRIP_SURFACE && hand->error_m < 1e-6 &&
                   fabs(pose.origin.position.z + 0.2) < 1e-6;
    hh_world_destroy(world);
    return is_right ? 0 : 1;
}
