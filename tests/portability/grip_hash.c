/* A scene through the C interface: a player climbs a wall and shakes a chain while crates fly
 * about. Prints the state hash after 3 s and the median time of a step. With an argument it plays
 * so many times, and each line ends with the mean time of a step.
 * game/web/package/test/same_scene.mjs makes the same calls, and must get the same hash. */
#include <handhold/handhold.h>
#include <stdio.h>
#include <stdlib.h>

enum { k_frames = 270, k_links = 12, k_crates = 20 };

static hh_world* g_world;

static void check(hh_result result) {
    if (result != HH_OK) {
        fprintf(stderr, "%s: %s\n", hh_result_text(result), hh_last_error());
        exit(2);
    }
}

static double clamped(double x) { return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x; }

/* Both palms face the wall. The right hand grips it and pulls up; the left one grips the chain's
 * end and swings it. */
static hh_tracking_sample devices_at(double t_s) {
    hh_tracking_sample sample = hh_default_tracking_sample();
    const double swing = clamped(t_s - 1.0) - 2.0 * clamped(t_s - 1.5) + clamped(2.0 * t_s - 4.5);
    sample.time_s = t_s;
    sample.head.position.y = 1.6;
    for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
        sample.hands[side].position = (hh_vec3){side == HH_RIGHT ? 0.2 : -0.2, 1.4, -0.43};
        sample.hands[side].rotation = (hh_quat){0.70710678118654757, 0.0, 0.0, 0.70710678118654757};
        sample.grab[side] = t_s >= 0.5;
    }
    sample.hands[HH_RIGHT].position.y -= 0.3 * clamped(t_s - 1.0);
    sample.hands[HH_LEFT].position.x -= 0.4 * swing;
    return sample;
}

static void add_wall(void) {
    hh_body_def def = hh_default_body_def();
    def.name = "wall";
    check(hh_shape_add_box(g_world, (hh_vec3){1.0, 2.0, 0.1}, &def.shape));
    def.pose.position = (hh_vec3){0.95, 1.5, -0.6};
    hh_body id;
    check(hh_body_add(g_world, &def, &id));
}

/* Capsules that hang from the ball joints between them, down to the left hand. */
static void add_chain(void) {
    hh_shape shape;
    check(hh_shape_add_capsule(g_world, 0.03, 0.05, &shape));
    hh_joint_def joint = hh_default_joint_def();
    for (int i = 0; i < k_links; ++i) {
        hh_body_def def = hh_default_body_def();
        char name[32];
        snprintf(name, sizeof name, "link%d", i);
        def.name = name;
        def.kind = HH_DYNAMIC;
        def.shape = shape;
        def.mass_kg = 0.5;
        def.pose.position = (hh_vec3){-0.2, 1.4 + 0.125 * i, -0.52};
        check(hh_body_add(g_world, &def, &joint.body_b));
        hh_joint id;
        if (i > 0) {
            joint.kind = HH_BALL;
            joint.frame.position = (hh_vec3){-0.2, 1.4 + 0.125 * i - 0.0625, -0.52};
            check(hh_joint_add(g_world, &joint, &id));
        }
        joint.body_a = joint.body_b;
    }
}

static void add_crates(void) {
    hh_shape box;
    hh_shape hull;
    const hh_vec3 corners[] = {
        {0.0, 0.2, 0.0}, {0.2, -0.1, 0.0}, {-0.1, -0.1, 0.15}, {-0.1, -0.1, -0.15}};
    check(hh_shape_add_box(g_world, (hh_vec3){0.15, 0.1, 0.12}, &box));
    check(hh_shape_add_hull(g_world, corners, 4, &hull));
    for (int i = 0; i < k_crates; ++i) {
        hh_body_def def = hh_default_body_def();
        char name[32];
        snprintf(name, sizeof name, "crate%d", i);
        def.name = name;
        def.kind = HH_DYNAMIC;
        def.shape = i % 2 == 0 ? box : hull;
        def.mass_kg = 1.0 + 0.25 * i;
        def.pose.position = (hh_vec3){0.3 * (i % 5) - 0.6, 0.5 + 0.35 * (i / 5), -1.5};
        def.velocity_mps = (hh_vec3){0.1 * (i % 3) - 0.1, 0.02 * i - 0.2, 0.3 - 0.03 * i};
        def.angular_velocity_radps = (hh_vec3){0.5, 0.1 * i, -0.3};
        hh_body id;
        check(hh_body_add(g_world, &def, &id));
    }
}

static int less(const void* a, const void* b) {
    const double x = *(const double*)a;
    const double y = *(const double*)b;
    return (x > y) - (x < y);
}

static void play(int says_mean) {
    check(hh_world_create(NULL, &g_world));
    add_wall();
    add_chain();
    add_crates();
    hh_player_def you = hh_default_player_def();
    you.name = "you";
    hh_player_input input = hh_default_player_input();
    check(hh_player_add(g_world, &you, &input.player));
    const hh_pose wrist = hh_identity_pose();
    check(hh_player_set_hand_in_controller(g_world, input.player, HH_LEFT, &wrist));
    check(hh_player_set_hand_in_controller(g_world, input.player, HH_RIGHT, &wrist));
    static double step_us[k_frames];
    double sum_us = 0.0;
    for (int frame = 1; frame <= k_frames; ++frame) {
        const hh_tracking_sample sample = devices_at(frame / 90.0);
        input.samples = &sample;
        input.sample_count = 1;
        check(hh_world_step(g_world, 1.0 / 90.0, &input, 1));
        hh_world_stats stats = hh_default_world_stats();
        check(hh_world_get_stats(g_world, &stats));
        step_us[frame - 1] = stats.step_us;
        sum_us += stats.step_us;
    }
    hh_player_pose pose;
    check(hh_world_player_poses(g_world, &input.player, 1, &pose));
    uint64_t hash = 0;
    check(hh_world_hash(g_world, &hash));
    qsort(step_us, k_frames, sizeof step_us[0], less);
    printf("0x%016llx grips %d %d step_us %.1f", (unsigned long long)hash, (int)pose.hands[0].grip,
           (int)pose.hands[1].grip, step_us[k_frames / 2]);
    if (says_mean) {
        printf(" mean_us %.1f", sum_us / k_frames);
    }
    printf("\n");
    hh_world_destroy(g_world);
}

int main(int argc, char** argv) {
    const int plays = argc > 1 ? atoi(argv[1]) : 1;
    for (int i = 0; i < plays; ++i) {
        play(argc > 1);
    }
    return 0;
}
