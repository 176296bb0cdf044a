// Scenarios of the talk through whole frames: rows 4 (inside the step), 6 (moving supports) and 7
// (designer physics). Expected values are closed forms of the hands' motion; nothing is read back
// from the solver.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_physics_test {
namespace {

constexpr double k_half_turn_rad = 3.14159265358979323846;

double jump(double t_s, double at_s) { return t_s > at_s ? 1.0 : 0.0; }

struct RockCase {
    double mass_kg;
    bool crate;
};
std::string name_of_case(const testing::TestParamInfo<RockCase>& info) {
    const std::string mass =
        info.param.mass_kg < 1.0 ? "half" : std::to_string(std::lround(info.param.mass_kg));
    return mass + "_kg_" + (info.param.crate ? "box" : "sphere");
}

class HeldRock : public testing::TestWithParam<RockCase> {
  protected:
    static constexpr double k_radius_m = 0.08;
    Entity add_rock_under_palm(Scenario& s) const {
        const Vec3 center = palm_ - Vec3(0.0, k_radius_m + 0.005, 0.0);
        return GetParam().crate
                   ? s.add_crate("rock", GetParam().mass_kg, center, Vec3::Constant(k_radius_m))
                   : s.add_rock("rock", GetParam().mass_kg, center, k_radius_m);
    }
    const Vec3 palm_ = Vec3(0.3, 1.2, 0.0);
};

TEST_P(HeldRock, WavingItNeverMovesThePlayer) {
    Scenario s;
    add_rock_under_palm(s);
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm_);
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        const double w = ease(t, 0.0, 0.5);
        return Pose{
            hand + w * Vec3(0.3 * std::sin(6 * t), 0.2 * std::sin(4 * t), 0.1 * std::sin(9 * t)),
            rotation_about(Vec3::UnitX(), 0.8 * w * std::sin(5 * t))};
    };
    const Vec3 before = s.origin_ws();
    int held = 0;
    s.run(5.0, [&] {
        ASSERT_EQ(s.origin_ws(), before);  // bitwise
        held += s.grab(HandSide::right).kind == GripKind::held ? 1 : 0;
        EXPECT_LE(s.grab(HandSide::right).error_m, 1e-6);
    });
    EXPECT_GT(held, 400);
}

// A wall 10 cm in front of the rock; the hand moves 30 cm. The player is pushed by what the wall
// blocks, in the same frame.
struct ShoveResult {
    double penetration_m = 0.0;
    // Difference of push-back and violation along the wall's normal.
    double push_error_m = 0.0;
    double sideways_m = 0.0;
    int pushes = 0;
};
ShoveResult shove(Scenario& s, Entity rock, double radius_m, const Vec3& hand, double wall_z) {
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    ShoveResult result;
    Vec3 origin = s.origin();
    Vec3 velocity = s.velocity();
    s.run(1.2, [&] {
        const Vec3 predicted = origin + velocity / s.hz;
        const Vec3 hand_ps = s.world.hand_tracking.at(s.player.hands[1]).pose_ps.position;
        // The rock began at z = 0 under the hand.
        const double wanted_z = (predicted + hand_ps - hand).z() - radius_m;
        const double violation = std::max(0.0, wall_z - wanted_z);
        const Vec3 push = s.origin() - predicted;
        result.pushes += violation > 1e-3 ? 1 : 0;
        result.push_error_m = std::max(result.push_error_m, std::abs(push.z() - violation));
        result.sideways_m = std::max(result.sideways_m, push.head<2>().norm());
        result.penetration_m =
            std::max(result.penetration_m, wall_z - (s.body(rock).position.z() - radius_m));
        origin = s.origin();
        velocity = s.velocity();
    });
    return result;
}

TEST_P(HeldRock, ShovedIntoWallPushesPlayerByTheViolationInTheSameFrame) {
    Scenario s;
    const Entity rock = add_rock_under_palm(s);
    s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, -k_radius_m - 0.10 - 0.05));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm_);
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        return Pose{hand - Vec3(0.0, 0.0, std::clamp(1.5 * (t - 0.5), 0.0, 0.3)), Quat::Identity()};
    };
    const ShoveResult result = shove(s, rock, k_radius_m, hand, -k_radius_m - 0.10);
    EXPECT_GE(result.pushes, 1);
    EXPECT_LE(result.penetration_m, 1e-6);
    EXPECT_LE(result.push_error_m, 1e-6);
    EXPECT_LE(result.sideways_m, 1e-6);
}

TEST_P(HeldRock, JumpingThirtyCentimetresInAFramePushesInsteadOfTunnelling) {
    Scenario s;
    s.tuning.tracking.max_hand_speed_mps = 1e3;  // the jump is followed
    const Entity rock = add_rock_under_palm(s);
    s.add_wall("wall", Vec3(2.0, 2.0, 0.01),
               Vec3(0.0, 1.0, -k_radius_m - 0.10 - 0.01));  // 2 cm thin: crossed within one frame
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm_);
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        return Pose{hand - Vec3(0.0, 0.0, 0.3 * jump(t, 0.5)), Quat::Identity()};
    };
    const ShoveResult result = shove(s, rock, k_radius_m, hand, -k_radius_m - 0.10);
    EXPECT_GE(result.pushes, 1);
    EXPECT_LE(result.penetration_m, 1e-6);
    EXPECT_LE(result.push_error_m, 1e-6);
    EXPECT_LE(result.sideways_m, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Masses, HeldRock,
                         testing::Values(RockCase{0.5, false}, RockCase{5.0, false},
                                         RockCase{50.0, false}, RockCase{0.5, true},
                                         RockCase{5.0, true}, RockCase{50.0, true}),
                         name_of_case);

TEST(HeadContact, LeaningIntoTheGrippedWallStaysOutside) {
    Scenario s;
    const double wall_z = -0.6;
    s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, wall_z - 0.05));
    s.add_player_here();
    const Quat palm_forward = rotation_about(Vec3::UnitX(), 0.5 * k_half_turn_rad);
    const Vec3 hand = Vec3(0.2, 1.4, wall_z + 0.01) - palm_forward * s.tuning.hand.palm_center_m;
    s.script.hands[1] = [=](double) { return Pose{hand, palm_forward}; };
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.head = [](double t) {
        return Pose{Vec3(0.0, 1.6, -0.2 - 0.5 * ease(t, 0.5, 1.0)), Quat::Identity()};
    };
    s.run(1.5, [&] {
        const double gap = s.head_center().z() - s.tuning.head.radius_m - wall_z;
        ASSERT_GE(gap, -1e-6);
    });
    EXPECT_EQ(s.grab(HandSide::right).kind, GripKind::surface);
    // The head's target is 16 cm inside the wall: the hand's error grows by as much, the grip is
    // not released, nothing is thrown.
    EXPECT_NEAR(s.grab(HandSide::right).error_m, 0.16, 1e-6);
    EXPECT_LE(s.velocity().norm(), 1e-6);
}

struct Ship {
    double speed_mps;
    bool turns;
};
class OnShip : public testing::TestWithParam<Ship> {
  protected:
    // Hand-relative path on a support with the parameter's motion, seen from the ship.
    static std::vector<Vec3> crawl(const Ship& ship, double& worst_error_m, int& single_frames) {
        Scenario s;
        const Entity hull = s.add_wall("ship", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
        const Vec3 velocity(ship.speed_mps, 0.0, 0.0);
        s.world.reference_velocity_mps = velocity;
        s.set_motion(hull, velocity, Vec3(0.0, ship.turns ? 0.3 : 0.0, 0.0), ship.turns);
        s.add_player_here(Vec3::Zero(), velocity);
        const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
        s.script.hands[1] = [=](double t) {
            const double w = 0.2 * ease(t, 0.3, 1.0);
            return Pose{hand + w * Vec3(std::sin(3 * t), std::cos(2 * t), std::sin(2 * t)),
                        Quat::Identity()};
        };
        s.script.grabs[1] = [](double t) { return t > 0.005; };
        std::vector<Vec3> path;
        s.run(4.0, [&] {
            const Grab& grab = s.grab(HandSide::right);
            if (grab.kind == GripKind::surface) {
                ++single_frames;
                const Vec3 target =
                    s.world.render_pose.at(s.player.player).hands[1].tracked_ws.position;
                const Vec3 anchor =
                    transform_point(s.world.body_pose.at(hull).pose_ws, grab.anchor_bs.position);
                worst_error_m = std::max(worst_error_m, (target - anchor).norm());
            }
            path.push_back(
                inverse_transform_point(s.world.body_pose.at(hull).pose_ws, s.origin_ws()));
        });
        return path;
    }
};

TEST_P(OnShip, SingleGripHasNoLag) {
    double worst_m = 0.0;
    int frames = 0;
    crawl(GetParam(), worst_m, frames);
    EXPECT_GT(frames, 350);
    EXPECT_LE(worst_m, 1e-8);
}

TEST_P(OnShip, PathSeenFromTheShipDoesNotDependOnItsSpeed) {
    double unused_m = 0.0;
    int frames = 0;
    const std::vector<Vec3> moving = crawl(GetParam(), unused_m, frames);
    const std::vector<Vec3> resting = crawl({0.0, GetParam().turns}, unused_m, frames);
    ASSERT_EQ(moving.size(), resting.size());
    if (GetParam().turns) {
        // A turning velocity bends the drift before the grip: only straight flight looks the same
        // from inside.
        return;
    }
    for (std::size_t i = 0; i < moving.size(); ++i) {
        ASSERT_LE((moving[i] - resting[i]).norm(), 1e-6) << "frame " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, OnShip,
                         testing::Values(Ship{0.0, false}, Ship{20.0, false}, Ship{1000.0, false},
                                         Ship{0.0, true}, Ship{20.0, true}, Ship{1000.0, true}));

TEST(Release, ThrowsThePlayerAgainstTheHandsVelocity) {
    Scenario s;
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    s.add_wall("wall", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    const Vec3 pull_mps(0.0, -1.2, 0.7);
    const double from_s = 0.3;
    const double until_s = 0.505;
    s.script.hands[1] = [=](double t) {
        return Pose{hand + pull_mps * std::max(0.0, t - from_s), Quat::Identity()};
    };
    s.script.grabs[1] = [=](double t) { return t > 0.05 && t < until_s; };
    s.run(1.0);
    EXPECT_LE((s.velocity() + pull_mps).norm(), 1e-6);  // v_origin = v_anchor - v_hand
    // The player moved with the hand while it held, and drifts since: one straight line, whatever
    // frame the button edge fell into.
    EXPECT_LE((s.origin() + pull_mps * (s.t_s() - from_s)).norm(), 1e-5);
}

TEST(Release, FastHandsAreLimited) {
    Scenario s;
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    s.add_wall("wall", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    s.script.hands[1] = [=](double t) {
        return Pose{hand - Vec3(0.0, 9.0 * std::max(0.0, t - 0.3), 0.0), Quat::Identity()};
    };
    s.script.grabs[1] = [](double t) { return t > 0.05 && t < 0.405; };
    std::uint64_t clamped = 0;
    s.run(0.5, [&] { clamped += s.fallbacks(Fallback::release_speed_clamped); });
    EXPECT_NEAR(s.velocity().norm(), s.tuning.locomotion.release_speed_max_mps, 1e-9);
    EXPECT_EQ(clamped, 1U);
}

TEST(Release, ThrownObjectLeavesWithTheHandsMotionAtItsCentre) {
    Scenario s;
    const Entity bar = s.add_crate("bar", 1.0, Vec3(0.3, 1.2 - 0.025, 0.0), Vec3(0.3, 0.02, 0.02));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.2, 0.0));
    const Vec3 velocity_mps(0.4, 0.2, -1.0);
    const Vec3 spin_radps(0.0, 0.0, 2.0);
    const double until_s = 0.505;
    s.script.hands[1] = [=](double t) {
        const double moved = std::max(0.0, t - 0.3);
        return Pose{hand + velocity_mps * moved, rotation_from_vector(spin_radps * moved)};
    };
    s.script.grabs[1] = [=](double t) { return t > 0.05 && t < until_s; };
    s.run(0.5);
    ASSERT_EQ(s.grab(HandSide::right).kind, GripKind::held);
    s.run(2.0 / 90.0);
    ASSERT_EQ(s.grab(HandSide::right).kind, GripKind::none);
    // v_com = v_hand + w x (com - hand), with the arm at the end of the release frame. A spin about
    // a principal axis stays constant in free flight.
    EXPECT_LE((s.body_spin(bar) - spin_radps).norm(), 1e-6);
    const double released_end_s = std::ceil(until_s * s.hz) / s.hz;
    const Quat turned = rotation_from_vector(spin_radps * (released_end_s - 0.3));
    const Vec3 arm = turned * (Vec3(0.3, 1.175, 0.0) - hand);
    EXPECT_LE((s.body_velocity(bar) - (velocity_mps + spin_radps.cross(arm))).norm(), 1e-5);
}

TEST(PushOff, ExchangesMomentumExactlyIfKappaIsOne) {
    Scenario s;
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    s.tuning.locomotion.release_speed_max_mps = 1e6;
    s.tuning.locomotion.object_speed_max_mps = 1e6;
    s.tuning.phases.kappa_light_kg = 0.0;
    s.tuning.phases.kappa_heavy_kg = 1.0;
    const Entity crate = s.add_crate("crate", 50.0, Vec3(0.3, 0.9, 0.1), Vec3(0.2, 0.15, 0.2));
    const Vec3 drift(0.1, 0.05, -0.02);
    s.add_player_here(Vec3::Zero(), drift);
    s.world.body_velocity.at(crate).linear_mps = drift + Vec3(0.01, 0.02, 0.0);
    const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    s.script.hands[1] = [=](double t) {
        const double pushed = std::max(0.0, t - 0.3);
        return Pose{hand + Vec3(0.1 * std::sin(5 * t), -1.2 * pushed, 0.7 * pushed),
                    rotation_about(Vec3::UnitZ(), 0.3 * t)};
    };
    s.script.grabs[1] = [](double t) { return t > 0.05 && t < 0.505; };
    const auto momentum = [&] { return Vec3(80.0 * s.velocity() + 50.0 * s.body_velocity(crate)); };
    const Vec3 before = momentum();
    bool held = false;
    s.run(1.0, [&] {
        held = held || s.grab(HandSide::right).kind == GripKind::held;
        ASSERT_LE((momentum() - before).norm(), 1e-9 * before.norm());
    });
    EXPECT_TRUE(held);
    EXPECT_GT((s.velocity() - s.body_velocity(crate)).norm(), 1.0);  // they were pushed off
}

// A rock is waved, then shoved into a wall and held there.
TEST(Ledger, ReportsEachReceiversGainAndWhatForwardDiscarded) {
    Scenario s;
    s.tuning.locomotion.drift_drag_per_s = 0.0;
    s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, -0.6));
    const Vec3 palm(0.3, 1.2, 0.0);
    const Entity rock = s.add_rock("rock", 5.0, palm - Vec3(0.0, 0.085, 0.0));
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm);
    s.script.hands[1] = [=](double t) {
        const Vec3 wave(0.1 * std::sin(5 * t), 0.1 * std::sin(4 * t), -0.9 * ease(t, 1.0, 2.0));
        return Pose{hand + ease(t, 0.2, 0.5) * wave, Quat::Identity()};
    };
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    Vec3 rock_before = Vec3::Zero();
    Vec3 player_before = Vec3::Zero();
    double discarded_ns = 0.0;
    double fixed_ns = 0.0;
    s.run(2.5, [&] {
        const Vec3 rock_now = 5.0 * s.body_velocity(rock);
        const Vec3 player_now = 80.0 * s.velocity();
        const auto& given = s.stats.ledger.linear_kgmps;
        ASSERT_LE((given[MomentumLedger::objects] - (rock_now - rock_before)).norm(), 1e-9);
        ASSERT_LE((given[MomentumLedger::players] - (player_now - player_before)).norm(), 1e-9);
        if (s.t_s() < 1.0) {  // waving is borne by the virtual player only
            const Vec3 both =
                given[MomentumLedger::objects] + given[MomentumLedger::virtual_player];
            ASSERT_LE(both.norm(), 1e-9);
            ASSERT_EQ(given[MomentumLedger::players], Vec3::Zero());
            discarded_ns += given[MomentumLedger::virtual_player].norm();
        }
        fixed_ns += given[MomentumLedger::statics].norm();
        rock_before = rock_now;
        player_before = player_now;
    });
    EXPECT_GT(discarded_ns, 5.0);
    EXPECT_GT(fixed_ns, 5.0);
    EXPECT_GT(s.origin().z(), 0.2);  // the player was pushed back
}

}  // namespace
}  // namespace handhold::scenario_physics_test
