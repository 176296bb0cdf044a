// Scenes in free space: waving rocks, riding ships, pushing off and throwing.
#include <algorithm>
#include <cmath>

#include "components/player.hpp"
#include "tools/lab/hand_paths.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

// Disables drag and speed limits, so only constraints change momentum.
void take_off_limits(Tuning& tuning) {
    tuning.locomotion.drift_drag_per_s = 0.0;
    tuning.locomotion.release_speed_max_mps = 1e6;
    tuning.locomotion.object_speed_max_mps = 1e6;
    tuning.locomotion.object_spin_max_radps = 1e3;
}

const std::vector<Vec3>& wave_corners() {
    static const std::vector<Vec3> k_corners = {Vec3::Zero(), Vec3(0.4, 0.0, 0.0),
                                                Vec3(0.1, 0.3, 0.0), Vec3(0.1, 0.0, -0.3)};
    return k_corners;
}

Pose wave(double t_s) {
    const Quat turn =
        rotation_about(Vec3(1.0, 2.0, -1.0).normalized(), triangle_wave(t_s, k_twist_rad, 2.0));
    return {along_polygon(wave_corners(), t_s, k_hand_speed_mps) + tremor(t_s), turn};
}

}  // namespace

// Rocks of 0.5, 5 and 50 kg, each held by its own player.
LabScene make_wave(const SceneOptions& /*options*/) {
    LabScene scene;
    for (const double mass_kg : {0.5, 5.0, 50.0}) {
        const Vec3 place(0.0, 0.0, 10.0 * static_cast<double>(scene.players.size()));
        LabHold hold;
        hold.player = static_cast<int>(scene.players.size());
        hold.body = add_box(scene, "rock" + std::to_string(hold.player), mass_kg,
                            Vec3::Constant(0.08), place + Vec3(0.0, 0.0, -0.08));
        hold.hand_ps = wave;
        scene.players.push_back({place});
        scene.add_hold(hold);
    }
    scene.players_still_until_s = k_never_s;
    return scene;
}

// A ship flies on a circle at 20 m/s. A player holds on to the ship and moves their arm.
LabScene make_ship_kinematic(const SceneOptions& /*options*/) {
    LabScene scene;
    static constexpr double k_turn_radps = 0.2;
    static constexpr double k_radius_m = 20.0 / k_turn_radps;
    LabBody ship;
    ship.name = "ship";
    ship.kind = BodyKind::kinematic;
    ship.half_m = Vec3(3.0, 2.0, 5.0);
    ship.drive = [](double t_s) {
        const double angle = k_turn_radps * t_s;
        return Pose{k_radius_m * Vec3(std::sin(angle), 0.0, std::cos(angle) - 1.0),
                    rotation_about(Vec3::UnitY(), angle)};
    };
    scene.add_body(ship);
    scene.players.push_back({Vec3(0.0, 0.0, 5.0)});
    scene.players.back().velocity_mps = Vec3(20.0, 0.0, 0.0);
    LabHold hold;
    hold.point_only = true;
    hold.hand_ps = wave;
    scene.add_hold(hold);
    scene.needs_player = true;
    const Vec3 anchor = scene.holds.front().anchor_bs;
    // The expected pose is the closed form of the ship's path at this time.
    scene.watch = [drive = ship.drive, anchor](const FrameRecord& frame, Figures& figures) {
        const Vec3 expected = transform_point(drive(frame.t_s), anchor) - wave(frame.t_s).position;
        figures.take_worst("ship_lag_mm", 1e3 * (frame.poses[1].position - expected).norm());
    };
    return scene;
}

// Like make_ship_kinematic, but with a free ship of 10 t: the momentum that player and ship
// exchange must be conserved.
LabScene make_ship_dynamic(const SceneOptions& /*options*/) {
    LabScene scene;
    const int ship = add_box(scene, "ship", 1e4, Vec3(3.0, 2.0, 5.0), Vec3::Zero());
    LabBody& body = scene.bodies.back();
    body.velocity = {Vec3(5.0, 0.0, 0.0), Vec3(0.0, 0.1, 0.0)};
    scene.players.push_back({Vec3(0.0, 0.0, 5.0)});
    scene.players.back().velocity_mps =
        body.velocity.linear_mps + body.velocity.angular_radps.cross(Vec3(0.0, 0.0, 5.0));
    LabHold hold;
    hold.body = ship;
    hold.point_only = true;
    hold.hand_ps = wave;
    scene.add_hold(hold);
    take_off_limits(scene.tuning);
    scene.closed_from_s = 0.0;
    scene.watch = [](const FrameRecord& frame, Figures& figures) {
        const Vec3 anchor_ws = transform_point(frame.poses[0], Vec3(0.0, 0.0, 5.0));
        const Vec3 lag = frame.poses[1].position + wave(frame.t_s).position - anchor_ws;
        figures.take_worst("ship_lag_mm", 1e3 * lag.norm());
    };
    return scene;
}

// A player pushes a crate of 50 kg away with kappa 1 (the share of a push that moves the player).
// Both must get the speeds that follow from momentum conservation.
LabScene make_push_off(const SceneOptions& /*options*/) {
    LabScene scene;
    constexpr double k_mass_kg = 50.0;
    constexpr double k_begin_s = 0.1;
    constexpr double k_release_s = 0.4;
    LabHold hold;
    hold.body = add_box(scene, "crate", k_mass_kg, Vec3::Constant(0.2), Vec3(0.3, 0.0, 0.0));
    scene.players.emplace_back();
    hold.hand_ps = [](double t_s) {
        const double pushed_m = k_hand_speed_mps * std::max(0.0, t_s - k_begin_s);
        return Pose{Vec3(0.3 + pushed_m, 0.0, 0.0), Quat::Identity()};
    };
    hold.release_s = k_release_s;
    scene.add_hold(hold);
    take_off_limits(scene.tuning);
    scene.tuning.phases.kappa_light_kg = 0.0;
    scene.tuning.phases.kappa_heavy_kg = 1.0;
    scene.closed_from_s = 0.0;
    scene.beyond_bullet = "kappa, the share of a push that moves the player";
    scene.watch = [](const FrameRecord& frame, Figures& figures) {
        if (frame.t_s < k_release_s + 2.0 * frame.dt_s) {
            return;
        }
        const double player_kg = PlayerBody{}.mass_kg;
        const double share = k_hand_speed_mps / (k_mass_kg + player_kg);
        const Vec3 crate(share * player_kg, 0.0, 0.0);
        const Vec3 player(-share * k_mass_kg, 0.0, 0.0);
        figures.set("push_off_crate_error_mps", (frame.velocities[0].linear_mps - crate).norm());
        figures.set("push_off_player_error_mps", (frame.velocities[1].linear_mps - player).norm());
    };
    return scene;
}

// A bar of 1 kg is held at one end of its middle part and thrown with spin. It must leave with the
// hand's velocity.
LabScene make_throw(const SceneOptions& /*options*/) {
    LabScene scene;
    constexpr double k_release_s = 0.5;
    const Vec3 velocity(0.0, 0.0, -3.0);
    const Vec3 spin(0.0, 6.0, 0.0);
    LabHold hold;
    hold.body = add_box(scene, "bar", 1.0, Vec3(0.3, 0.02, 0.02), Vec3(-0.2, 0.0, 0.0));
    scene.players.emplace_back();
    hold.hand_ps = [velocity, spin](double t_s) {
        return Pose{velocity * t_s, rotation_from_vector(spin * t_s)};
    };
    hold.release_s = k_release_s;
    scene.add_hold(hold);
    take_off_limits(scene.tuning);
    // The hand releases in the frame of the first sample at or after k_release_s. At 90 Hz, 0.03 s
    // covers that frame; then the bar is free.
    scene.closed_from_s = k_release_s + 0.03;
    scene.closed_in_spin = true;
    scene.watch = [velocity, spin, left_s = 0.0](const FrameRecord& frame,
                                                 Figures& figures) mutable {
        if (frame.t_s < k_release_s || frame.held.front() != 0) {
            return;
        }
        left_s = left_s > 0.0 ? left_s : frame.t_s;  // samples are at the ends of frames
        const Vec3 arm = rotation_from_vector(spin * left_s) * Vec3(-0.2, 0.0, 0.0);
        const Vec3 expected = velocity + spin.cross(arm);
        figures.take_worst("throw_speed_error_mps",
                           (frame.velocities[0].linear_mps - expected).norm());
        figures.take_worst("throw_spin_error_radps",
                           (frame.velocities[0].angular_radps - spin).norm());
    };
    return scene;
}

}  // namespace handhold::lab
