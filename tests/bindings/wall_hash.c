/* A host with physics of its own: a hand grips a plane that only the host knows, and pulls the
 * player through the host's solver. Prints the state hash after 2 s, the grip and how far the
 * player came. The tests of the bindings make the same calls, and must print the same line. */
#include <handhold/handhold.h>
#include <stdio.h>
#include <stdlib.h>

static hh_body g_wall;
static const double k_wall_z_m = -0.5;
static const double k_dt_s = 1.0 / 90.0;

static void check(hh_result result) {
    if (result != HH_OK) {
        fprintf(stderr, "%s: %s\n", hh_result_text(result), hh_last_error());
        exit(2);
    }
}

static double clamped(double x) { return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x; }

static uint8_t is_skipped(const hh_body* skip, size_t skip_count) {
    for (size_t i = 0; i < skip_count; ++i) {
        if (skip[i].index == g_wall.index && skip[i].generation == g_wall.generation) {
            return 1;
        }
    }
    return 0;
}

static void hit_at(double x, double y, double distance_m, hh_surface_hit* hit) {
    hit->body = g_wall;
    hit->point = (hh_vec3){x, y, k_wall_z_m};
    hit->normal = (hh_vec3){0.0, 0.0, 1.0};
    hit->distance_m = distance_m;
}

static uint8_t cast_ray(void* context, hh_vec3 from, hh_vec3 to, const hh_body* skip,
                        size_t skip_count, hh_surface_hit* hit) {
    (void)context;
    if (is_skipped(skip, skip_count) || from.z < k_wall_z_m || to.z >= k_wall_z_m) {
        return 0;
    }
    const double part = (from.z - k_wall_z_m) / (from.z - to.z);
    hit_at(from.x + part * (to.x - from.x), from.y + part * (to.y - from.y), 0.0, hit);
    return 1;
}

static uint8_t closest_point(void* context, hh_vec3 point, double max_distance_m,
                             const hh_body* skip, size_t skip_count, hh_surface_hit* hit) {
    (void)context;
    const double distance_m = point.z < k_wall_z_m ? 0.0 : point.z - k_wall_z_m;
    if (is_skipped(skip, skip_count) || distance_m > max_distance_m) {
        return 0;
    }
    hit_at(point.x, point.y, distance_m, hit);
    return 1;
}

static uint8_t closest_point_on(void* context, hh_body body, hh_vec3 point, hh_surface_hit* hit) {
    return body.index == g_wall.index ? closest_point(context, point, 1e9, NULL, 0, hit) : 0;
}

int main(void) {
    hh_world* world = NULL;
    check(hh_world_create(NULL, &world));
    hh_surface_query query = hh_default_surface_query();
    query.cast_ray = cast_ray;
    query.closest_point = closest_point;
    query.closest_point_on = closest_point_on;
    check(hh_world_set_surface_query(world, &query));
    hh_body_def wall = hh_default_body_def();
    wall.name = "wall";
    wall.pose.position = (hh_vec3){0.0, 1.5, k_wall_z_m};
    check(hh_body_add(world, &wall, &g_wall));
    hh_player_def you = hh_default_player_def();
    you.name = "you";
    hh_player_input input = hh_default_player_input();
    check(hh_player_add(world, &you, &input.player));
    const hh_pose wrist = hh_identity_pose();
    check(hh_player_set_hand_in_controller(world, input.player, HH_LEFT, &wrist));
    check(hh_player_set_hand_in_controller(world, input.player, HH_RIGHT, &wrist));
    int grabs = 0;
    for (int frame = 1; frame <= 180; ++frame) {
        hh_tracking_sample sample = hh_default_tracking_sample();
        sample.time_s = frame / 90.0;
        sample.head.position.y = 1.6;
        for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
            sample.hands[side].position = (hh_vec3){side == HH_RIGHT ? 0.2 : -0.2, 1.4, -0.43};
            sample.hands[side].rotation =
                (hh_quat){0.70710678118654757, 0.0, 0.0, 0.70710678118654757};
        }
        sample.hands[HH_RIGHT].position.z += 0.2 * clamped(2.0 * (sample.time_s - 1.0));
        sample.grab[HH_RIGHT] = sample.time_s >= 0.5;
        input.samples = &sample;
        input.sample_count = 1;
        check(hh_world_begin_step(world, k_dt_s, &input, 1));
        const hh_player_motion* motions = NULL;
        const hh_hand_constraint* hands = NULL;
        size_t motion_count = 0;
        size_t hand_count = 0;
        check(hh_world_player_motions(world, &motions, &motion_count));
        check(hh_world_hand_constraints(world, &hands, &hand_count));
        const hh_vec3 start = motions[0].origin;
        const hh_vec3 speed = motions[0].velocity_mps;
        hh_vec3 end = {start.x + k_dt_s * speed.x, start.y + k_dt_s * speed.y,
                       start.z + k_dt_s * speed.z};
        for (size_t i = 0; i < hand_count; ++i) {
            end.x = hands[i].anchor_end.position.x - hands[i].target.position.x;
            end.y = hands[i].anchor_end.position.y - hands[i].target.position.y;
            end.z = hands[i].anchor_end.position.z - hands[i].target.position.z;
        }
        hh_solved_player solved = {input.player, end, {0.0, 0.0, 0.0}};
        solved.velocity_mps.x = (end.x - start.x) / k_dt_s;
        solved.velocity_mps.y = (end.y - start.y) / k_dt_s;
        solved.velocity_mps.z = (end.z - start.z) / k_dt_s;
        check(hh_world_end_step(world, &solved, 1));
        const hh_event* events = NULL;
        size_t event_count = 0;
        check(hh_world_events(world, &events, &event_count));
        for (size_t i = 0; i < event_count; ++i) {
            grabs += events[i].kind == HH_EVENT_GRABBED;
        }
    }
    hh_player_pose pose;
    check(hh_world_player_poses(world, &input.player, 1, &pose));
    uint64_t hash = 0;
    check(hh_world_hash(world, &hash));
    printf("0x%016llx grabs %d moved_mm %.3f\n", (unsigned long long)hash, grabs,
           -1000.0 * pose.origin.position.z);
    hh_world_destroy(world);
    return 0;
}
