// Scenes in which rocks and heads meet walls. A wall's surface is at x = 0 and faces +x.
#include <algorithm>
#include <cmath>

#include "tools/lab/hand_paths.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

constexpr double k_rock_half_m = 0.08;
constexpr double k_gap_m = 0.1;      // gap between rock and wall at the start
constexpr double k_too_far_m = 0.2;  // distance that the hand moves into the wall
constexpr double k_wave_s = 0.5;     // duration of the first movement, along the wall
constexpr double k_wall_half_m = 0.5;

void add_wall(LabScene& scene) {
    LabBody wall;
    wall.name = "wall";
    wall.kind = BodyKind::fixed;
    wall.half_m = Vec3(k_wall_half_m, 2.0, 2.0);
    wall.pose_ws.position.x() = -k_wall_half_m;
    wall.collides = true;
    scene.add_body(wall);
    scene.planes.push_back({Vec3::UnitX(), 0.0});
}

int add_rock(LabScene& scene, double mass_kg, const Vec3& center) {
    LabBody rock;
    rock.name = "rock" + std::to_string(scene.bodies.size());
    rock.mass_kg = mass_kg;
    rock.half_m = Vec3::Constant(k_rock_half_m);
    rock.pose_ws.position = center;
    rock.collides = true;
    return scene.add_body(rock);
}

void add_player_before_wall(LabScene& scene) {
    scene.players.emplace_back();
    scene.players.back().head_ps = Vec3(0.8, 0.6, 1.5);
    scene.players.back().head_meets_planes = true;
}

// A player holds a rock 10 cm from a wall and moves it along the wall, then into it. `into_wall`:
// distance towards the wall at a time.
LabScene make_rock_before_wall(const std::function<double(double)>& into_wall) {
    LabScene scene;
    add_wall(scene);
    const int rock = add_rock(scene, 5.0, Vec3(k_rock_half_m + k_gap_m, 0.0, 0.0));
    add_player_before_wall(scene);
    LabHold hold;
    hold.body = rock;
    hold.hand_ps = [into_wall](double t_s) {
        const double along = triangle_wave(std::min(t_s, k_wave_s), 0.25, k_hand_speed_mps);
        return Pose{Vec3(k_rock_half_m + k_gap_m - into_wall(t_s), along, 0.0), Quat::Identity()};
    };
    scene.add_hold(hold);
    scene.needs_player = true;
    return scene;
}

}  // namespace

LabScene make_shove(const SceneOptions& /*options*/) {
    const auto into_wall = [](double t_s) {
        return std::clamp(k_hand_speed_mps * (t_s - k_wave_s), 0.0, k_gap_m + k_too_far_m);
    };
    LabScene scene = make_rock_before_wall(into_wall);
    scene.players_still_until_s = k_wave_s + k_gap_m / k_hand_speed_mps;
    const double stop_s = k_wave_s + (k_gap_m + k_too_far_m) / k_hand_speed_mps;
    // While the hand moves into the wall, the player moves away from the wall by the same distance.
    // When the hand stops, nothing holds the player at the wall. The player keeps the velocity of
    // the push. The held rock of 5 kg is lighter than PhaseTuning::kappa_light_kg, so its mass does
    // not affect the player.
    scene.watch = [into_wall, stop_s](const FrameRecord& frame, Figures& figures) {
        if (frame.t_s <= stop_s) {
            const Vec3 expected = std::max(0.0, into_wall(frame.t_s) - k_gap_m) * Vec3::UnitX();
            figures.take_worst("push_back_error_mm",
                               1e3 * (frame.poses[2].position - expected).norm());
        } else if (frame.t_s > stop_s + 2.0 * frame.dt_s) {
            figures.take_worst("drift_mps", frame.velocities[2].linear_mps.norm());
            figures.set("drift_expected_mps", k_hand_speed_mps);
        }
    };
    return scene;
}

LabScene make_shove_mesh(const SceneOptions& options) {
    LabScene scene = make_shove(options);
    scene.bodies.front().is_mesh = true;
    return scene;
}

LabScene make_step(const SceneOptions& /*options*/) {
    const auto into_wall = [](double t_s) { return t_s < k_wave_s ? 0.0 : k_gap_m + k_too_far_m; };
    LabScene scene = make_rock_before_wall(into_wall);
    scene.players_still_until_s = k_wave_s;
    scene.watch = [into_wall](const FrameRecord& frame, Figures& figures) {
        const bool jumped =
            into_wall(frame.t_s) > 0.0 && into_wall(frame.t_s - 0.99 * frame.dt_s) <= 0.0;
        if (jumped) {
            const Vec3 expected = k_too_far_m * Vec3::UnitX();
            figures.set("push_back_error_mm", 1e3 * (frame.poses[2].position - expected).norm());
        }
    };
    return scene;
}

LabScene make_lean_in(const SceneOptions& /*options*/) {
    LabScene scene;
    add_wall(scene);
    scene.players.emplace_back();
    constexpr double k_head_m = 0.4;
    scene.players.back().head_ps = Vec3(k_head_m, 0.3, 0.0);
    scene.players.back().head_meets_planes = true;
    const double gap_m = k_head_m - scene.tuning.head.radius_m;
    const auto pull = [gap_m](double t_s) {
        return triangle_wave(t_s, gap_m + 0.1, k_hand_speed_mps);
    };
    LabHold hold;
    hold.point_only = true;
    hold.hand_ps = [pull](double t_s) { return Pose{Vec3(pull(t_s), 0.0, 0.0), Quat::Identity()}; };
    scene.add_hold(hold);
    scene.needs_player = true;
    // Contacts have priority over hands: the head stops at the wall, and the rest of the movement
    // becomes the hand's error.
    scene.watch = [pull, gap_m](const FrameRecord& frame, Figures& figures) {
        const Vec3 expected(-std::min(pull(frame.t_s), gap_m), 0.0, 0.0);
        figures.take_worst("push_back_error_mm", 1e3 * (frame.poses[1].position - expected).norm());
    };
    return scene;
}

// A hand holds a rock of 16 cm in a gap that closes from 20 to 14 cm. The hand moves back and forth
// and then rests.
LabScene make_jam(const SceneOptions& options) {
    LabScene scene;
    add_wall(scene);
    static constexpr double k_closed_m = 0.14;
    static constexpr double k_open_m = 0.20;
    const auto gap = [](double t_s) { return std::max(k_closed_m, k_open_m - 0.1 * t_s); };
    LabBody jaw = scene.bodies.front();
    jaw.name = "jaw";
    jaw.kind = BodyKind::kinematic;
    jaw.drive = [gap](double t_s) {
        return Pose{Vec3(gap(t_s) + k_wall_half_m, 0.0, 0.0), Quat::Identity()};
    };
    jaw.pose_ws = jaw.drive(0.0);
    scene.planes.push_back({-Vec3::UnitX(), k_wall_half_m, scene.add_body(jaw)});
    const int rock = add_rock(scene, 5.0, Vec3(0.5 * k_open_m + 0.003, 0.0, 0.0));
    scene.players.emplace_back();
    scene.players.back().head_ps = Vec3(0.07, 0.6, 4.0);
    const double rest_s = 0.5 * options.duration_s;
    const Vec3 start = scene.bodies.back().pose_ws.position;
    LabHold hold;
    hold.body = rock;
    hold.hand_ps = [start, rest_s](double t_s) {
        const double sway = 0.05 * std::sin(2.0 * k_pi * std::min(t_s, rest_s));
        return Pose{start + sway * Vec3::UnitX(), Quat::Identity()};
    };
    scene.add_hold(hold);
    scene.needs_player = true;
    const double settled_s = 0.75 * options.duration_s;
    scene.watch = [rock, settled_s, gap, last = Vec3(Vec3::Zero())](const FrameRecord& frame,
                                                                    Figures& figures) mutable {
        const Vec3& center = frame.poses[static_cast<std::size_t>(rock)].position;
        if (frame.t_s >= settled_s) {
            figures.set("jam_gap_left_mm", 1e3 * (k_rock_half_m - center.x()));
            figures.set("jam_gap_right_mm", 1e3 * (center.x() + k_rock_half_m - gap(frame.t_s)));
            figures.take_worst("still_mps", (center - last).norm() / frame.dt_s);
        }
        last = center;
    };
    return scene;
}

// Boxes hit the wall flat at 2 m/s and must leave it at e times that speed (e: restitution).
LabScene make_bounce(const SceneOptions& /*options*/) {
    LabScene scene;
    add_wall(scene);
    constexpr double k_speed_mps = 2.0;
    for (const double restitution : {0.2, 0.5, 0.9}) {
        const int rock = add_rock(scene, 1.0, Vec3(0.37, 2.0 * (restitution - 0.5), 0.0));
        scene.bodies.back().restitution = restitution;
        scene.bodies.back().velocity.linear_mps = Vec3(-k_speed_mps, 0.0, 0.0);
        static_cast<void>(rock);
    }
    scene.watch = [bodies = scene.bodies](const FrameRecord& frame, Figures& figures) {
        for (std::size_t i = 1; i < bodies.size(); ++i) {
            const double speed = frame.velocities[i].linear_mps.x();
            if (speed > -k_speed_mps + 1e-9) {
                figures.take_worst("restitution_error",
                                   std::abs(speed / k_speed_mps - bodies[i].restitution));
            }
        }
    };
    return scene;
}

// A block slides on a floor that is accelerated upwards with a = 9.81 m/s^2. It must slide v^2 / (2
// mu a) (v: speed, mu: friction).
LabScene make_slide(const SceneOptions& options) {
    LabScene scene;
    constexpr double k_push_mps2 = 9.81;
    constexpr double k_friction = 0.5;
    constexpr double k_speed_mps = 2.0;
    LabBody floor;
    floor.name = "floor";
    floor.kind = BodyKind::kinematic;
    floor.half_m = Vec3(20.0, 1.0, 20.0);
    floor.collides = true;
    floor.friction = k_friction;
    // The floor gains the same speed in every step.
    const double dt_s = 1.0 / options.hz;
    floor.drive = [dt_s](double t_s) {
        return Pose{Vec3(0.0, 0.5 * k_push_mps2 * t_s * (t_s + dt_s) - 1.0, 0.0), Quat::Identity()};
    };
    floor.pose_ws = floor.drive(0.0);
    scene.planes.push_back({Vec3::UnitY(), 1.0, scene.add_body(floor)});
    const int block = add_rock(scene, 1.0, Vec3(0.0, k_rock_half_m, 0.0));
    scene.bodies.back().friction = k_friction;
    scene.bodies.back().velocity.linear_mps.x() = k_speed_mps;
    const double expected = k_speed_mps * k_speed_mps / (2.0 * k_friction * k_push_mps2);
    scene.watch = [block, expected](const FrameRecord& frame, Figures& figures) {
        const double slid = frame.poses[static_cast<std::size_t>(block)].position.x();
        figures.set("sliding_distance_m", slid);
        figures.set("sliding_expected_m", expected);
        figures.set("sliding_error_mm", 1e3 * std::abs(slid - expected));
        // The error that a first-order integrator may have: the path of one frame.
        figures.set("sliding_step_mm", 1e3 * k_speed_mps * frame.dt_s);
    };
    return scene;
}

}  // namespace handhold::lab
