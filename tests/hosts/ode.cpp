// Open Dynamics Engine as a host: ODE owns every body and moves it; Handhold gives the hands. A
// player crawls along a wall, carries and throws a crate, pulls a hinge door, and rides on a
// platform; with hands pulled by ODE's solver (level c), with held bodies moved by Handhold, and
// with the host's own locomotion (level b). Prints figures. Exit status 0: all goals are met.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ode_scene.hpp"

namespace scenes {

// Hand over hand to the right: each hand closes, pulls 0.4 m to the left, opens, and swings back.
void crawl() {
    Scene scene;
    scene.engine.add_box(host::Kind::fixed, {20.0, 2.0, 0.1}, hh::pose_at({0.0, 1.5, -0.6}), 0.0);
    scene.begin();
    long most = 0;
    for (int frame = 0; frame < 540; ++frame) {
        Devices devices;
        for (int side = 0; side < 2; ++side) {
            const double phase = std::fmod(scene.t_s + k_dt_s + (side == 0 ? 0.5 : 0.0), 1.0);
            const double pulled = phase < 0.6 ? ease(phase / 0.6) : 1.0 - ease((phase - 0.6) / 0.4);
            devices.wrist[side].x += 0.2 - 0.4 * pulled;
            devices.closed[side] = phase > 0.05 && phase < 0.55;
        }
        const long before = scene.engine.queries();
        scene.step(devices);
        most = std::max(most, scene.engine.queries() - before);
    }
    const double moved_m = scene.pose().origin.position.x;
    std::printf("crawl: %.2f m in %.1f s, hand error %.2g mm; %.1f queries a frame, at most %ld\n",
                moved_m, scene.t_s, 1e3 * scene.worst_fixed_m,
                static_cast<double>(scene.engine.queries()) / scene.steps, most);
    expect(moved_m > 3.0, "the player crawls");
    expect(scene.worst_fixed_m <= k_exact_m, "hand error on a wall");
}

// The right hand takes a crate, carries it aside, turns it and throws it.
void carry_and_throw() {
    Scene scene;
    const std::size_t crate = scene.engine.add_box(host::Kind::dynamic, {0.15, 0.15, 0.15},
                                                   hh::pose_at({0.2, 1.48, -0.65}), 10.0);
    scene.begin();
    Devices devices;
    hh::Vec3 thrown{};
    double carried_m = 0.0;
    for (int frame = 0; frame < 270; ++frame) {
        const double t = scene.t_s + k_dt_s;
        const double lift = ease((t - 0.6) / 0.8);
        const double push = std::max(0.0, t - 1.6);
        const hh::Quat roll = host::turn_about({0.0, 0.0, 1.0}, 0.8 * lift);
        devices.turn[1] = host::multiply(roll, k_palm_ahead);
        devices.wrist[1] = {0.2 - 0.3 * lift, 1.4 + 0.2 * lift, -0.43 - 1.5 * push};
        devices.closed[1] = t > 0.3 && t < 1.8;
        if (t > 2.0) {
            devices.wrist[1] = {-0.1, 1.6, -0.9};
        }
        scene.step(devices);
        if (t > 0.5 && t < 1.7) {
            expect(grips(scene, 1, crate), "the crate is held");
            carried_m = scene.engine.box(crate).pose().position.y - 1.48;
        }
        if (t > 1.8 && host::length(thrown) == 0.0) {
            thrown = scene.engine.velocity(crate);
        }
    }
    const hh::Vec3 now = scene.engine.velocity(crate);
    std::printf("crate: hand error %.2g mm, carried up %.3f m, thrown at %.4f m/s\n",
                1e3 * scene.worst_dynamic_m, carried_m, thrown.z);
    expect(scene.worst_dynamic_m > 0.0 && scene.worst_dynamic_m <= k_dynamic_m,
           "hand error on a crate");
    expect(carried_m > 0.1, "the crate follows");
    expect(std::fabs(thrown.z + 1.5) < 0.01, "the throw has the hand's velocity");
    expect(host::length(now - thrown) < 1e-6, "a thrown crate flies on");
}

// A door on ODE's hinge follows the hand that pulls its edge.
void pull_door() {
    Scene scene;
    const std::size_t door = scene.engine.add_box(host::Kind::dynamic, {0.4, 1.0, 0.02},
                                                  hh::pose_at({-0.2, 1.4, -0.52}), 15.0);
    scene.engine.add_hinge(door, {-0.6, 1.4, -0.52}, -1.5, 1.5);
    scene.begin();
    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = scene.engine.box(door).id;
    hinge.frame = hh::pose_at({-0.6, 1.4, -0.52}, {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)});
    expect(static_cast<bool>(scene.world.add(hinge)), "the hinge");
    Devices devices;
    devices.wrist[1].x = 0.1;
    double angle_rad = 0.0;
    for (int frame = 0; frame < 180; ++frame) {
        const double t = scene.t_s + k_dt_s;
        devices.closed[1] = t > 0.2;
        devices.wrist[1].z = -0.43 + 0.25 * ease((t - 0.4) / 1.2);
        scene.step(devices);
        const hh::Quat q = scene.engine.box(door).pose().rotation;
        angle_rad = 2.0 * std::atan2(q.y, q.w);
    }
    expect(grips(scene, 1, door), "the door is held");
    std::printf("door: %.3f rad, hand error %.2g mm\n", angle_rad, 1e3 * scene.worst_dynamic_m);
    expect(std::fabs(angle_rad) > 0.3, "the door follows");
    expect(scene.worst_dynamic_m > 0.0 && scene.worst_dynamic_m <= k_dynamic_m,
           "hand error on a door");
}

// Both hands hold a crate and turn it between them.
void carry_with_two_hands() {
    Scene scene;
    const std::size_t crate = scene.engine.add_box(host::Kind::dynamic, {0.35, 0.15, 0.15},
                                                   hh::pose_at({0.0, 1.48, -0.65}), 20.0);
    scene.begin();
    Devices devices;
    double roll_rad = 0.0;
    double worst_m = 0.0;
    for (int frame = 0; frame < 270; ++frame) {
        const double t = scene.t_s + k_dt_s;
        const double wave = ease((t - 0.6) / 1.5);
        const hh::Quat roll = host::turn_about({0.0, 0.0, 1.0}, 0.5 * wave);
        for (int side = 0; side < 2; ++side) {
            const double x = side == 0 ? -0.2 : 0.2;
            devices.turn[side] = host::multiply(roll, k_palm_ahead);
            devices.wrist[side] = hh::Vec3{0.0, 1.4 + 0.1 * wave, -0.43 - 0.1 * wave} +
                                  host::rotate(roll, {x, 0.0, 0.0});
            devices.closed[side] = t > 0.2 + 0.1 * side;
        }
        scene.step(devices);
        const hh::Pose pose = scene.engine.box(crate).pose();
        roll_rad = 2.0 * std::atan2(pose.rotation.z, pose.rotation.w);
        for (int side = 0; side < 2 && t > 0.4; ++side) {
            expect(grips(scene, side, crate), "both hands hold the crate");
            const hh::Vec3 wrist = host::at(scene.pose().origin, devices.wrist[side]);
            const hh::Vec3 anchor = host::at(pose, scene.hand(side).anchor.position);
            worst_m = std::max(worst_m, host::length(wrist - anchor));
        }
    }
    std::printf("two hands: crate turned by %.3f rad, hand error %.2g mm\n", roll_rad,
                1e3 * worst_m);
    expect(std::fabs(roll_rad - 0.5) < 0.01, "the crate turns with both hands");
    expect(worst_m <= k_dynamic_m, "hand error with two hands");
}

// A held crate that hits a wall pushes the player back, and does not enter the wall.
void push_off_with_a_crate() {
    Scene scene;
    const std::size_t crate = scene.engine.add_box(host::Kind::dynamic, {0.15, 0.15, 0.15},
                                                   hh::pose_at({0.2, 1.48, -0.65}), 10.0);
    scene.engine.add_box(host::Kind::fixed, {2.0, 2.0, 0.1}, hh::pose_at({0.0, 1.5, -1.0}), 0.0);
    scene.begin();
    Devices devices;
    double deepest_m = 0.0;
    for (int frame = 0; frame < 180; ++frame) {
        const double t = scene.t_s + k_dt_s;
        devices.closed[1] = t > 0.2;
        devices.wrist[1].z = -0.43 - 0.3 * ease((t - 0.4) / 0.8);
        scene.step(devices);
        const double front_m = scene.engine.box(crate).pose().position.z - 0.15;
        deepest_m = std::max(deepest_m, -0.9 - front_m);
    }
    const double back_m = scene.pose().origin.position.z;
    std::printf(
        "crate against a wall: player pushed back %.3f m, crate %.2g mm inside, hand error "
        "%.2g mm\n",
        back_m, 1e3 * deepest_m, 1e3 * scene.worst_dynamic_m);
    expect(grips(scene, 1, crate), "the crate is held");
    expect(back_m > 0.19, "the wall pushes the player back");
    expect(deepest_m < 2e-3, "the crate stays outside of the wall");
    expect(scene.worst_dynamic_m <= k_dynamic_m, "hand error against a wall");
}

// A body as heavy as a vehicle: player and body share their momentum.
void pull_on_a_heavy_body() {
    Scene scene;
    const std::size_t ship = scene.engine.add_box(host::Kind::dynamic, {2.0, 1.0, 0.5},
                                                  hh::pose_at({0.2, 1.48, -1.0}), 2000.0);
    scene.begin();
    expect(static_cast<bool>(scene.world.tune("locomotion.drift_drag_per_s", 0.0)), "no drag");
    Devices devices;
    for (int frame = 0; frame < 180; ++frame) {
        const double t = scene.t_s + k_dt_s;
        devices.closed[1] = t > 0.2 && t < 1.2;
        devices.wrist[1].z = -0.43 + 0.3 * std::clamp(t - 0.6, 0.0, 1.0);
        scene.step(devices);
    }
    const double player_mps = scene.pose().velocity_mps.z;
    const double ship_mps = scene.engine.velocity(ship).z;
    const double momentum = 80.0 * player_mps + 2000.0 * ship_mps;
    std::printf(
        "heavy body: player %.4f m/s, body %.5f m/s, momentum %.2g kg m/s, hand error "
        "%.2g mm\n",
        player_mps, ship_mps, momentum, 1e3 * scene.worst_dynamic_m);
    expect(std::fabs(ship_mps - player_mps - 0.3) < 0.01, "they part at the hand's speed");
    expect(std::fabs(momentum) < 0.01, "momentum is kept");
    expect(scene.worst_dynamic_m <= k_dynamic_m, "hand error on a heavy body");
}

static hh::Pose platform_at(double t_s) {
    return hh::pose_at({0.5 * std::sin(t_s), 1.4 + 0.3 * std::sin(0.7 * t_s), -0.6},
                       host::turn_about({0.0, 1.0, 0.0}, 0.4 * std::sin(1.3 * t_s)));
}

// A driven platform carries the player who holds on to it.
void ride() {
    Scene scene;
    const std::size_t platform =
        scene.engine.add_box(host::Kind::driven, {0.6, 0.5, 0.1}, platform_at(0.0), 50.0);
    scene.begin();
    Devices devices;
    double travel_m = 0.0;
    for (int frame = 0; frame < 450; ++frame) {
        devices.closed[1] = scene.t_s > 0.1;
        scene.engine.drive(platform, platform_at(scene.t_s + k_dt_s), k_dt_s);
        scene.step(devices);
        travel_m = std::max(travel_m, host::length(scene.pose().origin.position));
    }
    expect(grips(scene, 1, platform), "the platform is held");
    std::printf("platform: carried %.2f m, hand error %.2g mm\n", travel_m,
                1e3 * scene.worst_fixed_m);
    expect(travel_m > 0.4, "the platform carries the player");
    expect(scene.worst_fixed_m <= k_exact_m, "hand error on a platform");
}

}  // namespace scenes

int main() {
    using namespace scenes;
    crawl();
    carry_and_throw();
    pull_door();
    carry_with_two_hands();
    push_off_with_a_crate();
    pull_on_a_heavy_body();
    ride();
    carry_by_handhold();
    hold_by_host();
    compare_costs();
    std::printf("ODE: %s\n", g_failures == 0 ? "all goals met" : "goals missed");
    return g_failures == 0 ? 0 : 1;
}
