/* A wall and a player whose right hand grips it and pulls: the guide's first program in C99. */
#include <math.h>
#include <stdio.h>

#include <handhold/handhold.h>

/* [devices] */
/* What the headset says at t_s: the right palm faces the wall, closes at 0.5 s and pulls 0.2 m. */
static hh_tracking_sample devices_at(double t_s) {
    hh_tracking_sample sample = hh_default_tracking_sample();
    sample.time_s = t_s;
    sample.head.position.y = 1.6;
    for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
        sample.hands[side].position = (hh_vec3){side == HH_RIGHT ? 0.2 : -0.2, 1.4, -0.43};
        sample.hands[side].rotation = (hh_quat){sqrt(0.5), 0.0, 0.0, sqrt(0.5)};
    }
    sample.hands[HH_RIGHT].position.z += 0.4 * (fmin(fmax(t_s, 1.0), 1.5) - 1.0);
    sample.grab[HH_RIGHT] = t_s >= 0.5;
    return sample;
}
/* [devices] */

static hh_result g_worst = HH_OK;
static void check(hh_result result) {
    if (result != HH_OK) {
        fprintf(stderr, "%s: %s\n", hh_result_text(result), hh_last_error());
        g_worst = result;
    }
}

int main(void) {
    /* [hello] */
    hh_world* world = NULL;
    check(hh_world_create(NULL, &world));
    hh_body_def wall = hh_default_body_def(); /* static unless it says otherwise */
    check(hh_shape_add_box(world, (hh_vec3){2.0, 2.0, 0.1}, &wall.shape));
    wall.pose.position = (hh_vec3){0.0, 1.5, -0.6};
    hh_body wall_id;
    check(hh_body_add(world, &wall, &wall_id));

    hh_player_def you = hh_default_player_def();
    hh_player_input input = hh_default_player_input();
    check(hh_player_add(world, &you, &input.player));
    const hh_pose wrist = hh_identity_pose(); /* our samples are wrists, not controllers */
    check(hh_player_set_hand_in_controller(world, input.player, HH_LEFT, &wrist));
    check(hh_player_set_hand_in_controller(world, input.player, HH_RIGHT, &wrist));

    for (int frame = 1; frame <= 180; ++frame) {
        const hh_tracking_sample sample = devices_at(frame / 90.0);
        input.samples = &sample;
        input.sample_count = 1;
        check(hh_world_step(world, 1.0 / 90.0, &input, 1));
    }
    hh_player_pose pose; /* what your renderer draws */
    check(hh_world_player_poses(world, &input.player, 1, &pose));
    /* [hello] */
    const hh_hand_state* hand = &pose.hands[HH_RIGHT];
    printf("error %.1e m, %.4f m nearer\n", hand->error_m, -pose.origin.position.z);
    /* Closed form: a hand on a wall moves the player by as much as it moves towards the body. */
    const int is_right = g_worst == HH_OK && hand->grip == HH_GRIP_SURFACE &&
                         hand->body.index == wall_id.index && hand->error_m < 1e-6 &&
                         fabs(pose.origin.position.z + 0.2) < 1e-6;
    hh_world_destroy(world);
    return is_right ? 0 : 1;
}
