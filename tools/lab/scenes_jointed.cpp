// Bodies jointed to a wall: a lever, a drawer, a door. In the first half of a run the body can
// follow the hand. In the second half the hand pulls the body beyond its range.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/lab/hand_paths.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

constexpr double k_lever_m = 0.4;

// Distance of the pull: from 0 up to `height` and back to 0, once per second. `height` is 5, 10 and
// 20 cm in turn.
double pull_off(double t_s) {
    constexpr std::array k_heights = {0.05, 0.10, 0.20};
    if (t_s <= 0.0) {
        return 0.0;
    }
    const auto turn = static_cast<std::size_t>(t_s) % k_heights.size();
    const double part = t_s - std::floor(t_s);
    const double rise = std::min({part / 0.3, 1.0, (1.0 - part) / 0.3});
    return k_heights[turn] * smooth_step(rise, 0.0, 1.0);
}

// When the hand starts to pull too far. Never if there is no player, because nothing could yield.
double half_time(const SceneOptions& options) {
    return options.holder == Holder::player ? 0.5 * options.duration_s : k_never_s;
}

LabHold hold_body(const PathOfTime& path) {
    LabHold hold;
    hold.point_only = true;
    hold.hand_ps = path;
    return hold;
}

// Adds the body and the player who holds it.
void add_jointed_body(LabScene& scene, const std::string& name, double mass_kg, const Vec3& half_m,
                      const Vec3& center_ws) {
    add_box(scene, name, mass_kg, half_m, center_ws);
    scene.players.emplace_back();
}

}  // namespace

LabScene make_lever(const SceneOptions& options) {
    LabScene scene;
    add_jointed_body(scene, "lever", 2.0, Vec3(0.015, 0.5 * k_lever_m, 0.015),
                     Vec3(0.0, 0.5 * k_lever_m, 0.0));
    LabJoint hinge;
    hinge.kind = JointKind::hinge;
    hinge.limited = true;
    hinge.lower = -1.2;
    hinge.upper = 1.2;
    scene.add_joint_at(hinge, {Vec3::Zero(), rotation_between(Vec3::UnitX(), Vec3::UnitZ())});
    const double half_s = half_time(options);
    // After the lever has come to rest; otherwise the lever would push the player as it stops.
    const double pull_s = half_s + 0.2;
    scene.add_hold(hold_body([half_s, pull_s](double t_s) {
        const double angle =
            triangle_wave(std::min(t_s, half_s), 1.8, k_hand_speed_mps / k_lever_m, 0.9) - 0.9;
        const double twist = triangle_wave(t_s, k_twist_rad, 2.0);
        return Pose{
            Vec3(-k_lever_m * std::sin(angle), k_lever_m * std::cos(angle), pull_off(t_s - pull_s)),
            rotation_about(Vec3(1.0, 2.0, -1.0).normalized(), twist)};
    }));
    scene.players_still_until_s = pull_s;
    // The lever cannot follow along its hinge axis, so the player must move by the distance of the
    // pull.
    scene.watch = [pull_s](const FrameRecord& frame, Figures& figures) {
        const Vec3 expected(0.0, 0.0, -pull_off(frame.t_s - pull_s));
        figures.take_worst("push_back_error_mm", 1e3 * (frame.poses[1].position - expected).norm());
    };
    return scene;
}

LabScene make_drawer(const SceneOptions& options) {
    LabScene scene;
    add_jointed_body(scene, "drawer", 5.0, Vec3(0.2, 0.1, 0.2), Vec3(0.0, 0.0, -0.2));
    LabJoint slider;
    slider.kind = JointKind::slider;
    slider.limited = true;
    slider.upper = 0.3;
    scene.add_joint_at(slider, {Vec3::Zero(), rotation_between(Vec3::UnitX(), Vec3::UnitZ())});
    const double half_s = half_time(options);
    scene.add_hold(hold_body([half_s](double t_s) {
        const double out = t_s <= half_s ? triangle_wave(t_s, 0.28, k_hand_speed_mps)
                                         : triangle_wave(half_s, 0.28, k_hand_speed_mps) +
                                               2.0 * pull_off(t_s - half_s);
        return Pose{Vec3(0.0, 0.1, out),
                    rotation_about(Vec3::UnitX(), triangle_wave(t_s, k_twist_rad, 2.0))};
    }));
    scene.players_still_until_s = half_s;
    return scene;
}

LabScene make_door(const SceneOptions& options) {
    LabScene scene;
    add_jointed_body(scene, "door", 20.0, Vec3(0.4, 0.9, 0.02), Vec3(0.4, 0.0, 0.0));
    LabJoint hinge;
    hinge.kind = JointKind::hinge;
    hinge.limited = true;
    hinge.upper = 1.6;
    scene.add_joint_at(hinge, {Vec3::Zero(), rotation_between(Vec3::UnitX(), Vec3::UnitY())});
    const double half_s = half_time(options);
    scene.add_hold(hold_body([half_s](double t_s) {
        constexpr double k_edge_m = 0.75;
        const double turn = triangle_wave(t_s, 1.5, k_hand_speed_mps / k_edge_m);
        const double angle = t_s <= half_s
                                 ? turn
                                 : triangle_wave(half_s, 1.5, k_hand_speed_mps / k_edge_m) +
                                       4.0 * pull_off(t_s - half_s);
        return Pose{Vec3(k_edge_m * std::cos(angle), 0.1, -k_edge_m * std::sin(angle)),
                    rotation_about(Vec3::UnitZ(), triangle_wave(t_s, k_twist_rad, 2.0))};
    }));
    scene.players_still_until_s = half_s;
    return scene;
}

}  // namespace handhold::lab
