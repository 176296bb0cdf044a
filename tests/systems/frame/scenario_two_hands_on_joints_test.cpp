// Two hands on a jointed body, through whole frames. Hands move as the joint allows, which must not
// move the player, plus a common motion along the axle or off the rail, which moves the player by
// as much, whichever hand joins or leaves.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_two_hands_on_joints_test {
namespace {

constexpr double k_jump_m = 1e-5;  // error of the head: 0.01 mm
constexpr double k_palm_m = 1.03;  // a centimetre above the plank

// A plank on a joint to the world: about an axle, or along a rail.
struct Plank {
    Scenario scene;
    double joint_offset_m = 0.0;  // offset of the axle from the plank's centre

    void add(JointKind kind, const Vec3& axis, double mass_kg) {
        const Entity plank =
            scene.add_crate("plank", mass_kg, Vec3(0.0, 1.0, 0.0), Vec3(0.4, 0.02, 0.15));
        Joint settings;
        settings.kind = kind;
        settings.b = plank;
        const Pose frame{Vec3(joint_offset_m, 1.0, 0.0), rotation_between(Vec3::UnitX(), axis)};
        add_joint(scene.world, {"joint", joint_at(scene.world, settings, frame)});
        scene.add_player_here();
    }
    // `motion`: motion relative to the hand's rest pose.
    void move_hand(HandSide side, const std::function<Pose(double)>& motion, double from_s,
                   double to_s) {
        const double mirror = side == HandSide::left ? -1.0 : 1.0;
        const Vec3 palm(0.25 * mirror, k_palm_m, 0.0);
        const Vec3 hand =
            palm - Vec3(mirror, 1.0, 1.0).cwiseProduct(scene.tuning.hand.palm_center_m);
        scene.script.hands[index_of(side)] = [=](double t_s) {
            return motion(t_s) * Pose{hand, Quat::Identity()};
        };
        scene.script.grabs[index_of(side)] = [=](double t_s) { return t_s > from_s && t_s < to_s; };
    }
    bool holds(HandSide side) const { return scene.grab(side).kind == GripKind::held; }
};

struct Case {
    const char* name;
    JointKind kind;
    Vec3 axis;
    Vec3 off_axis;  // a direction that the joint blocks
    double joint_offset_m;
    double mass_kg;
};
const Case k_cases[] = {
    {"axle", JointKind::hinge, Vec3::UnitZ(), Vec3::UnitZ(), 0.0, 3.0},
    {"axle at the end", JointKind::hinge, Vec3::UnitZ(), Vec3::UnitZ(), 0.6, 3.0},
    {"upright axle", JointKind::hinge, Vec3::UnitY(), Vec3::UnitY(), -0.2, 1.0},
    {"rail", JointKind::slider, Vec3(0.6, 0.0, 0.8), Vec3(-0.8, 0.0, 0.6), 0.0, 5.0},
};

double wave(double t_s) { return 0.08 * ease(t_s, 0.2, 0.5) * std::sin(5.0 * t_s); }
// Up to 2 rad/s^2 or 2 m/s^2.
Pose swing(const Case& c, double t_s) {
    const Vec3 joint_ws(c.joint_offset_m, 1.0, 0.0);
    if (c.kind == JointKind::slider) {
        return {wave(t_s) * c.axis, Quat::Identity()};
    }
    const Quat turn = rotation_about(c.axis, wave(t_s));
    return {joint_ws - turn * joint_ws, turn};
}
Vec3 pull(const Case& c, double pull_m, double t_s) {
    return pull_m * ease(t_s, 0.2, 0.5) * std::sin(4.0 * t_s + 1.0) * c.off_axis;
}

// The right hand holds from 0.05 s, the left one from `joins_s`; `leaving` releases at 1.6 s.
struct Change {
    double sample_hz = 90.0;
    double pull_m = 0.0;
    double joins_s = 0.905;
    HandSide leaving = HandSide::left;
};

Plank make_plank(const Case& c, const Change& change) {
    Plank plank;
    plank.joint_offset_m = c.joint_offset_m;
    plank.scene.sample_hz = change.sample_hz;
    plank.scene.tuning.locomotion.drift_drag_per_s = 0.0;
    const auto motion = [c, change](double t_s) {
        return Pose{pull(c, change.pull_m, t_s), Quat::Identity()} * swing(c, t_s);
    };
    plank.add(c.kind, c.axis, c.mass_kg);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        plank.move_hand(side, motion, side == HandSide::left ? change.joins_s : 0.05,
                        side == change.leaving ? 1.6 : 1e9);
    }
    return plank;
}

void join_and_leave(const Case& c, const Change& change) {
    Plank plank = make_plank(c, change);
    int both = 0;
    double worst_m = 0.0;
    plank.scene.run(2.2, [&] {
        worst_m = std::max(worst_m, plank.scene.origin().norm());
        both += plank.holds(HandSide::left) && plank.holds(HandSide::right) ? 1 : 0;
    });
    EXPECT_LE(worst_m, k_jump_m) << c.name;
    EXPECT_GT(both, 50) << c.name;
    EXPECT_FALSE(plank.holds(change.leaving));
    EXPECT_TRUE(plank.holds(change.leaving == HandSide::left ? HandSide::right : HandSide::left));
}

TEST(TwoHandsOnJoints, JoiningLeavingAndPassingDoNotMoveTheHead) {
    for (const Case& c : k_cases) {
        for (const double sample_hz : {90.0, 1000.0}) {
            for (const HandSide leaving : {HandSide::left, HandSide::right}) {
                join_and_leave(c, {sample_hz, 0.0, 0.905, leaving});
            }
        }
    }
}

// The player pulls themselves around while the plank swings by up to 14 cm, with one hand or two:
// the player follows the pull, and the swing shakes them little more than a player a thousand times
// heavier.
TEST(TwoHandsOnJoints, JoiningAndLeavingAPulledBodyMoveTheHeadByThePullAlone) {
    constexpr double k_strayed_m = 3e-4;
    for (const Case& c : k_cases) {
        for (const double sample_hz : {90.0, 1000.0}) {
            for (const HandSide leaving : {HandSide::left, HandSide::right}) {
                Plank plank = make_plank(c, {sample_hz, 0.05, 0.905, leaving});
                Vec3 strayed = Vec3::Zero();
                plank.scene.run(2.2, [&] {
                    const Vec3 before = strayed;
                    strayed = plank.scene.origin() + pull(c, 0.05, plank.scene.t_s());
                    EXPECT_LE((strayed - before).norm(), k_jump_m)
                        << c.name << " " << sample_hz << " " << plank.scene.t_s();
                    EXPECT_LE(strayed.norm(), k_strayed_m) << c.name << " " << sample_hz;
                });
                EXPECT_FALSE(plank.holds(leaving)) << c.name;
            }
        }
    }
}

}  // namespace
}  // namespace handhold::scenario_two_hands_on_joints_test
