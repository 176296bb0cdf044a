#pragma once

// What the ODE scenes share: a player's devices, an engine with Handhold's world, and measurement.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "ode_engine.hpp"

namespace scenes {

using host::operator+;
using host::operator-;
using host::operator*;

inline constexpr double k_dt_s = 1.0 / 90.0;
inline constexpr double k_exact_m = 1e-4;    // a hand on a static or driven body
inline constexpr double k_dynamic_m = 1e-3;  // on one of ODE's dynamic bodies
inline const hh::Quat k_palm_ahead{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};

inline int g_failures = 0;

inline void expect(bool is_right, const std::string& what) {
    if (!is_right) {
        std::printf("FAILED: %s\n", what.c_str());
        ++g_failures;
    }
}

// From 0 to 1 with no jump of velocity.
inline double ease(double t) {
    const double x = std::clamp(t, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

// A player's devices at a time, and what the host expects of them.
struct Devices {
    hh::Vec3 wrist[2]{{-0.2, 1.4, -0.43}, {0.2, 1.4, -0.43}};
    hh::Quat turn[2]{k_palm_ahead, k_palm_ahead};
    bool closed[2]{};

    hh::Sample at(double time_s) const {
        hh::Sample sample = hh::sample();
        sample.time_s = time_s;
        sample.head.position.y = 1.6;
        for (int side = 0; side < 2; ++side) {
            sample.hands[side] = hh::pose_at(wrist[side], turn[side]);
            sample.grab[side] = closed[side];
        }
        return sample;
    }
};

// The engine and Handhold's world with one player.
struct Scene {
    host::Engine engine;
    hh::World world;
    hh::Player you{};
    double t_s = 0.0;
    double worst_fixed_m = 0.0;    // with one hand on a static or driven body
    double worst_dynamic_m = 0.0;  // on a dynamic one
    int steps = 0;

    void begin() {
        engine.register_for_hands(world);
        you = world.add(hh::player_def()).value_or({});
        expect(static_cast<bool>(world.use_wrists(you)), "use_wrists");
        engine.add_player_for_hands(you);
    }
    hh_hand_state hand(int side) const {
        return world.hand(you, side == 0 ? HH_LEFT : HH_RIGHT).value_or({});
    }
    hh_player_pose pose() const { return world.pose(you).value_or({}); }

    void step(const Devices& devices) {
        t_s += k_dt_s;
        const hh::Sample sample = devices.at(t_s);
        const hh_player_input input = hh::input(you, {&sample, 1});
        expect(engine.step_for_hands(world, k_dt_s, {&input, 1}), "step_for_hands");
        measure(devices);
    }

    // Errors from the engine's own poses: Handhold's error_m is not asked.
    void measure(const Devices& devices) {
        ++steps;
        const hh::Pose origin = pose().origin;
        const bool both = hand(0).grip != HH_GRIP_NONE && hand(1).grip != HH_GRIP_NONE;
        for (int side = 0; side < 2; ++side) {
            const hh_hand_state state = hand(side);
            for (std::size_t i = 0; i < engine.box_count(); ++i) {
                const host::Box& box = engine.box(i);
                if (state.grip == HH_GRIP_NONE || !(box.id == state.body)) {
                    continue;
                }
                const hh::Vec3 wrist = host::at(origin, devices.wrist[side]);
                const double error_m =
                    host::length(wrist - host::at(box.pose(), state.anchor.position));
                double& worst = box.kind == host::Kind::dynamic ? worst_dynamic_m : worst_fixed_m;
                worst = both ? worst : std::max(worst, error_m);
            }
        }
    }
};

inline bool grips(const Scene& scene, int side, std::size_t box) {
    const hh_hand_state hand = scene.hand(side);
    return hand.grip != HH_GRIP_NONE && hand.body == scene.engine.box(box).id;
}

// ODE keeps every body; hands pull players through its solver.
void crawl();
void carry_and_throw();
void pull_door();
void carry_with_two_hands();
void push_off_with_a_crate();
void pull_on_a_heavy_body();
void ride();
// Handhold moves bodies while hands hold them.
void carry_by_handhold();
// The host moves players and decides what hands hold.
void hold_by_host();
// Level (c) beside the runtime's own physics.
void compare_costs();

}  // namespace scenes
