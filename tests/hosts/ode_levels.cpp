// The other two ways: Handhold moves bodies while hands hold them; or the host moves players and
// decides what hands hold. And what level (c) costs.
#include <array>
#include <cstdint>
#include <vector>

#include "ode_scene.hpp"

namespace scenes {
namespace {

// The triangles of a box, for palm and fingers.
hh::Mesh box_mesh(hh::Vec3 half_m) {
    std::vector<float> xyz;
    for (int corner = 0; corner < 8; ++corner) {
        xyz.push_back(static_cast<float>((corner & 1) != 0 ? half_m.x : -half_m.x));
        xyz.push_back(static_cast<float>((corner & 2) != 0 ? half_m.y : -half_m.y));
        xyz.push_back(static_cast<float>((corner & 4) != 0 ? half_m.z : -half_m.z));
    }
    const std::vector<std::uint32_t> indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6,
                                                0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7,
                                                0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return hh::Mesh(xyz, indices);
}

double cost_us_per_player(int players, bool by_ode) {
    constexpr int k_steps = 200;
    constexpr int k_warm = 50;
    Scene scene;
    scene.engine.add_box(host::Kind::fixed, {200.0, 2.0, 0.1}, hh::pose_at({0.0, 1.5, -0.6}), 0.0);
    if (by_ode) {
        scene.engine.register_for_hands(scene.world);
        const hh::Mesh mesh = box_mesh({200.0, 2.0, 0.1});
        expect(static_cast<bool>(scene.world.set_surface(scene.engine.box(0).id, mesh)), "surface");
    } else {
        hh_body_def wall = hh::body_def();
        wall.shape = scene.world.add_box({200.0, 2.0, 0.1}).value_or({});
        wall.pose.position = {0.0, 1.5, -0.6};
        expect(static_cast<bool>(scene.world.add(wall)), "the wall");
    }
    std::vector<hh_player_input> inputs;
    for (int i = 0; i < players; ++i) {
        hh_player_def def = hh::player_def();
        def.origin.position.x = 1.5 * i;
        const hh::Player player = scene.world.add(def).value_or({});
        expect(static_cast<bool>(scene.world.use_wrists(player)), "use_wrists");
        scene.engine.add_player_for_hands(player);
        inputs.push_back(hh::input(player, {}));
    }
    double us = 0.0;
    for (int frame = 1; frame <= k_warm + k_steps; ++frame) {
        Devices devices;
        devices.closed[1] = frame > 10;
        devices.wrist[1].x += 0.1 * std::sin(0.05 * frame);
        const hh::Sample sample = devices.at(frame * k_dt_s);
        for (hh_player_input& input : inputs) {
            input.samples = &sample;
            input.sample_count = 1;
        }
        const double before_us = scene.engine.hands_us();
        if (by_ode) {
            expect(scene.engine.step_for_hands(scene.world, k_dt_s, inputs), "a step");
        } else {
            expect(static_cast<bool>(scene.world.step(k_dt_s, inputs)), "a step");
        }
        if (frame > k_warm) {
            us += by_ode ? scene.engine.hands_us() - before_us
                         : scene.world.stats().value_or({}).step_us;
        }
    }
    const hh_player_pose pose = scene.world.pose(inputs.front().player).value_or({});
    expect(pose.hands[1].grip == HH_GRIP_SURFACE, "the wall is held");
    return us / (k_steps * players);
}

}  // namespace

// A held crate is kinematic in ODE and goes where Handhold moves it; let go, it is ODE's again.
void carry_by_handhold() {
    Scene scene;
    const std::size_t crate = scene.engine.add_box(host::Kind::dynamic, {0.15, 0.15, 0.15},
                                                   hh::pose_at({0.2, 1.48, -0.65}), 10.0);
    scene.begin();
    hh::Body held{};
    std::size_t count = 0;
    bool was_held = false;
    Devices devices;
    for (int frame = 0; frame < 180; ++frame) {
        const double t = scene.t_s + k_dt_s;
        devices.closed[1] = t > 0.3 && t < 1.5;
        devices.wrist[1].x = 0.2 - 0.5 * std::max(0.0, t - 0.5);
        if (!was_held) {
            // Sends the poses of the bodies that no hand holds.
            scene.engine.place_for_hands(scene.world);
        }
        scene.t_s = t;
        const hh::Sample sample = devices.at(t);
        expect(static_cast<bool>(scene.world.step(k_dt_s, hh::input(scene.you, {&sample, 1}))),
               "a step");
        expect(hh_world_held_bodies(scene.world.get(), &held, 1, &count) == HH_OK, "held bodies");
        const bool is_held = count == 1 && held == scene.engine.box(crate).id;
        if (is_held || was_held) {
            hh::Vec3 velocity{};
            hh::Vec3 spin{};
            hh_body_velocity(scene.world.get(), scene.engine.box(crate).id, &velocity, &spin);
            scene.engine.set_kinematic(crate, is_held);
            scene.engine.set_motion(
                crate, scene.world.pose(scene.engine.box(crate).id).value_or({}), velocity, spin);
        }
        if (!is_held) {
            scene.engine.step(k_dt_s);
        }
        was_held = is_held;
        scene.measure(devices);
        expect(t < 0.4 || t > 1.45 || is_held, "the crate is held");
    }
    const hh::Vec3 thrown = scene.engine.velocity(crate);
    std::printf("crate moved by Handhold: hand error %.2g mm, thrown at %.4f m/s\n",
                1e3 * scene.worst_dynamic_m, thrown.x);
    expect(scene.worst_dynamic_m <= k_exact_m, "hand error on a crate that Handhold moves");
    expect(std::fabs(thrown.x + 0.5) < 0.01, "the throw has the hand's velocity");
}

// The host carries the player on a platform, and says that the right hand holds it.
void hold_by_host() {
    Scene scene;
    const hh::Vec3 half_m{0.6, 0.5, 0.1};
    const std::size_t platform =
        scene.engine.add_box(host::Kind::driven, half_m, hh::pose_at({0.0, 1.4, -0.6}), 50.0);
    scene.begin();
    const hh::Body id = scene.engine.box(platform).id;
    const hh::Mesh mesh = box_mesh(half_m);
    expect(hh_body_set_surface(scene.world.get(), id, mesh.get()) == HH_OK, "a surface");
    Devices devices;
    double worst_m = 0.0;
    for (int frame = 0; frame < 180; ++frame) {
        scene.t_s += k_dt_s;
        const double swing = 0.4 * std::sin(scene.t_s);
        const hh::Pose end =
            hh::pose_at({swing, 1.4, -0.6}, host::turn_about({0.0, 1.0, 0.0}, 0.2 * swing));
        scene.engine.drive(platform, end, k_dt_s);
        scene.engine.step(k_dt_s);
        const hh_body_motion motion{id, end, {0.4 * std::cos(scene.t_s), 0.0, 0.0}, {}};
        expect(hh_world_place_bodies(scene.world.get(), &motion, 1) == HH_OK, "place_bodies");
        // The host's locomotion: the player stands on the platform.
        const hh::Pose origin = hh::pose_at(host::at(end, {0.0, -1.4, 0.6}), end.rotation);
        expect(hh_player_place(scene.world.get(), scene.you, origin, motion.velocity_mps) == HH_OK,
               "player_place");
        if (frame == 30) {
            const hh_surface_hit found = scene.world.find_grip(scene.you, HH_RIGHT).value_or({});
            expect(found.body == id && found.distance_m < 0.07, "the platform is under the palm");
            expect(hh_hand_hold(scene.world.get(), scene.you, HH_RIGHT, id, nullptr) == HH_OK,
                   "hand_hold");
        }
        const hh::Sample sample = devices.at(scene.t_s);
        const hh_player_input input = hh::input(scene.you, {&sample, 1});
        expect(hh_world_step_hands(scene.world.get(), k_dt_s, &input, 1) == HH_OK, "step_hands");
        if (frame > 30) {
            const hh_hand_state hand = scene.hand(1);
            expect(hand.grip == HH_GRIP_SURFACE, "the platform is held");
            worst_m = std::max(worst_m, hand.error_m);
        }
    }
    const hh::Pose pose = scene.engine.box(platform).pose();
    const auto joints = scene.world.hand_joints(scene.you, HH_RIGHT, HH_SPACE_WORLD).value_or({});
    double farthest_m = 0.0;
    for (const std::size_t tip : {10, 15, 20, 25}) {
        hh::Vec3 nearest{};
        hh::Vec3 normal{};
        const double gap_m =
            host::closest_on_box(pose, half_m, joints[tip].pose.position, nearest, normal) -
            joints[tip].radius_m;
        farthest_m = std::max(farthest_m, gap_m);
    }
    const auto body = scene.world.body_joints(scene.you, HH_SPACE_WORLD).value_or({});
    const double wrist_m =
        host::length(body[HH_RIGHT_HAND].position - scene.hand(1).shown.position);
    std::printf("host's locomotion: hand error %.2g mm, fingertips within %.2f mm\n", 1e3 * worst_m,
                1e3 * farthest_m);
    expect(worst_m < 1e-6, "the hand stays where the host holds it");
    expect(farthest_m < 5e-3, "fingers close on the host's triangles");
    expect(wrist_m < 1e-9, "the arm ends at the shown wrist");
}

void compare_costs() {
    constexpr int k_players = 8;
    const double ode_us = cost_us_per_player(k_players, true);
    const double own_us = cost_us_per_player(k_players, false);
    std::printf(
        "cost of a gripping player: %.0f us with ODE's solver outside, %.0f us with the "
        "runtime's own physics\n",
        ode_us, own_us);
}

}  // namespace scenes
