// Scenes with more than one hand on a body.
#include <algorithm>
#include <cmath>

#include "tools/lab/hand_paths.hpp"
#include "tools/lab/measure.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
// Two players, 10 m apart. The first has both hands on a lever; each hand moves exactly on its arc.
// The second has both hands on a free bar; the distance between the hands varies by 2 mm, as real
// hands' does. The hand that gripped first must stay at its anchor. The anchor of the other hand
// must lie on the line through both hands.
LabScene make_two_hands(const SceneOptions& /*options*/) {
    LabScene scene;
    const int lever = add_box(scene, "lever", 2.0, Vec3(0.015, 0.2, 0.015), Vec3(0.0, 0.2, 0.0));
    LabJoint hinge;
    hinge.kind = JointKind::hinge;
    hinge.b = lever;
    scene.add_joint_at(hinge, {Vec3::Zero(), rotation_between(Vec3::UnitX(), Vec3::UnitZ())});
    const Vec3 aside(10.0, 0.0, 0.0);
    const int bar = add_box(scene, "bar", 5.0, Vec3(0.3, 0.02, 0.02), aside);
    scene.players = {LabPlayer{}, LabPlayer{aside}};
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const bool is_left = side == HandSide::left;
        const double arm = is_left ? 0.25 : 0.4;
        LabHold on_lever;
        on_lever.side = side;
        on_lever.body = lever;
        on_lever.point_only = true;
        on_lever.hand_ps = [arm](double t_s) {
            const double angle = triangle_wave(t_s, 1.6, k_hand_speed_mps / 0.4, 0.8) - 0.8;
            return Pose{arm * Vec3(-std::sin(angle), std::cos(angle), 0.0), Quat::Identity()};
        };
        scene.add_hold(on_lever);
        LabHold on_bar;
        on_bar.player = 1;
        on_bar.side = side;
        on_bar.body = bar;
        on_bar.hand_ps = [is_left](double t_s) {
            const Quat turn = rotation_about(Vec3::UnitY(), triangle_wave(t_s, 1.0, 2.0));
            const double stray = 0.002 * std::sin(2.0 * k_pi * 3.0 * t_s);
            const Vec3 hand =
                turn * Vec3((is_left ? -0.2 : 0.2) + (is_left ? 0.0 : stray), 0.0, 0.0);
            return Pose{hand + triangle_wave(t_s, 0.3, k_hand_speed_mps) * Vec3::UnitY(), turn};
        };
        scene.add_hold(on_bar);
    }
    scene.players_still_until_s = k_never_s;
    // Both hands hold from the start; the left one counts as the first. The holds are: left hand on
    // lever and bar, then right hand on lever and bar.
    scene.watch = [first = scene.holds[1], second = scene.holds[3]](const FrameRecord& frame,
                                                                    Figures& figures) {
        figures.take_worst("first_hand_error_mm",
                           1e3 * grab_error_m(first, frame.targets[1], frame.poses));
        const Pose& bar_ws = frame.poses[static_cast<std::size_t>(first.body)];
        const Vec3 line = (frame.targets[3].position - frame.targets[1].position).normalized();
        const Vec3 apart = transform_point(bar_ws, second.anchor_bs) - frame.targets[3].position;
        figures.take_worst("second_hand_beside_line_mm", 1e3 * line.cross(apart).norm());
    };
    return scene;
}

// Two players at the ends of one bar repeatedly pull it outward by 10 cm each. Their origins must
// approach each other by exactly the sum of both pulls.
LabScene make_two_players(const SceneOptions& /*options*/) {
    LabScene scene;
    const int bar = add_box(scene, "bar", 5.0, Vec3(0.6, 0.02, 0.02), Vec3::Zero());
    scene.players = {LabPlayer{Vec3(-0.5, 0.0, 0.0)}, LabPlayer{Vec3(0.5, 0.0, 0.0)}};
    const auto pull = [](double t_s) { return triangle_wave(t_s, 0.1, 0.2); };
    for (const int player : {0, 1}) {
        LabHold hold;
        hold.player = player;
        hold.body = bar;
        hold.hand_ps = [pull, player](double t_s) {
            return Pose{Vec3((player == 0 ? -1.0 : 1.0) * pull(t_s), 0.0, 0.0), Quat::Identity()};
        };
        scene.add_hold(hold);
    }
    scene.needs_player = true;
    scene.watch = [pull](const FrameRecord& frame, Figures& figures) {
        const Vec3 apart = frame.poses[2].position - frame.poses[1].position;
        // Along the bar's direction, since the bar may rotate.
        const Vec3 axis = frame.poses[0].rotation * Vec3::UnitX();
        figures.take_worst("push_back_error_mm",
                           1e3 * std::abs(apart.dot(axis) + 2.0 * pull(frame.t_s) - 1.0));
    };
    return scene;
}

// Both hands on one fixed body pull 20 cm apart. Each hand must get half of the error.
LabScene make_contradict(const SceneOptions& /*options*/) {
    LabScene scene;
    const int rail = add_box(scene, "rail", 0.0, Vec3(0.5, 0.02, 0.02), Vec3::Zero());
    scene.bodies[static_cast<std::size_t>(rail)].kind = BodyKind::fixed;
    scene.players.emplace_back();
    const auto pull = [](double t_s) { return triangle_wave(t_s, 0.1, 0.2); };
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const double sign = side == HandSide::left ? -1.0 : 1.0;
        LabHold hold;
        hold.side = side;
        hold.point_only = true;
        hold.hand_ps = [sign, pull](double t_s) {
            return Pose{Vec3(sign * (0.2 + pull(t_s)), 0.0, 0.0), Quat::Identity()};
        };
        scene.add_hold(hold);
    }
    scene.needs_player = true;
    scene.watch = [pull](const FrameRecord& frame, Figures& figures) {
        for (const std::size_t hand : {0U, 1U}) {
            const double sign = hand == 0 ? -1.0 : 1.0;
            const double left = (frame.targets[hand].position - sign * 0.2 * Vec3::UnitX()).norm();
            figures.take_worst("share_error_mm", 1e3 * std::abs(left - pull(frame.t_s)));
        }
    };
    return scene;
}

namespace {

// A hand that pulls its player along a rail, with tremor.
Vec3 climbing_hand(double t_s) {
    const double tremor_m = 1e-3 * std::sin(2.0 * k_pi * 10.0 * t_s);
    return {triangle_wave(t_s, 0.4, k_hand_speed_mps), tremor_m, 0.0};
}

// Offset of the left hand, so that its distance from the right hand varies.
Vec3 stray(double t_s) { return {0.002 * std::sin(2.0 * k_pi * 3.0 * t_s), 0.0, 0.0}; }

}  // namespace

// Two players pull themselves along one rail in the same way. The first uses the right hand; the
// second uses both, and the left one releases. The second player's head moves by half of the left
// hand's offset; after the release it keeps the offset of that moment.
LabScene make_climb(const SceneOptions& /*options*/) {
    LabScene scene;
    const int rail = add_box(scene, "rail", 0.0, Vec3(10.0, 0.02, 0.02), Vec3::Zero());
    scene.bodies[static_cast<std::size_t>(rail)].kind = BodyKind::fixed;
    const Vec3 aside(5.0, 0.0, 0.0);
    scene.players = {LabPlayer{}, LabPlayer{aside}};
    constexpr double k_leaves_s = 2.5;
    const auto add = [&](int player, HandSide side, double release_s) {
        const bool is_left = side == HandSide::left;
        LabHold hold;
        hold.player = player;
        hold.side = side;
        hold.body = rail;
        hold.point_only = true;
        hold.release_s = release_s;
        hold.hand_ps = [is_left](double t_s) {
            const Vec3 place(is_left ? -0.2 : 0.2, 0.0, 0.0);
            return Pose{place + climbing_hand(t_s) + (is_left ? stray(t_s) : Vec3::Zero()),
                        Quat::Identity()};
        };
        scene.add_hold(hold);
    };
    add(0, HandSide::right, k_never_s);
    add(1, HandSide::right, k_never_s);
    add(1, HandSide::left, k_leaves_s);
    scene.needs_player = true;
    // Figures: how far each head is from where it would be if no hand slipped.
    scene.watch = [aside, left_by = Vec3(Vec3::Zero()), held = true](const FrameRecord& frame,
                                                                     Figures& figures) mutable {
        const Vec3 travel = climbing_hand(frame.t_s) - climbing_hand(0.0);
        const Vec3 one = frame.poses[1].position + travel;
        const Vec3 two = frame.poses[2].position - aside + travel;
        const bool holds = frame.held[2] != 0;
        if (held) {
            left_by = -0.5 * stray(frame.t_s);
        }
        if (held && !holds) {
            figures.take_worst("head_jump_mm", 1e3 * (two - left_by).norm());
        }
        held = holds;
        figures.take_worst("head_path_one_hand_mm", 1e3 * one.norm());
        figures.take_worst("head_path_two_hands_mm", 1e3 * (two - left_by).norm());
    };
    return scene;
}

}  // namespace handhold::lab
