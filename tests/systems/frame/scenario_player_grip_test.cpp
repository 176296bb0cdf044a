// One player grips another's head, through whole frames. Expected values are closed forms of the
// motions of hands and heads.
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/two_players.hpp"

namespace handhold::scenario_player_grip_test {
namespace {

constexpr double k_grab_s = 0.1;
constexpr std::size_t k_holder = 0;
constexpr std::size_t k_held = 1;
const Vec3 k_resting_palm = Vec3(0.0, 1.75, -0.5);  // just above the other's head

// The holder's right palm rests on the other's head.
struct Pair : test::TwoPlayers {
    explicit Pair(double holder_kg = 80.0, double held_kg = 80.0) {
        add_players({"holder", "held"}, {holder_kg, held_kg});
        const double radius_m = tuning.head.radius_m;
        const Vec3 crown = k_resting_palm - Vec3(0.0, 0.005, 0.0);
        const Vec3 center = crown - Vec3(0.0, radius_m, 0.0);
        scripts[k_held].head = [=, offset = tuning.head.center_m](double) {
            return Pose{center - offset, Quat::Identity()};
        };
        move_hand([](double) { return Vec3(Vec3::Zero()); });
        hold_until(1e9);
    }
    // Moves the right hand relative to its rest position.
    void move_hand(const std::function<Vec3(double)>& way) {
        const Vec3 rest = k_resting_palm - tuning.hand.palm_center_m;
        scripts[k_holder].hands[index_of(HandSide::right)] = [=](double t) {
            return Pose{rest + way(t), Quat::Identity()};
        };
    }
    void hold_until(double release_s) {
        scripts[k_holder].grabs[index_of(HandSide::right)] = [=](double t) {
            return t > k_grab_s && t < release_s;
        };
    }
    // A wall whose top is under a left palm. Returns the hand's position there.
    Vec3 add_wall_under_left_palm() {
        const Vec3 palm(-0.3, 1.2, 0.0);
        add_body(world, {"wall",
                         {},
                         {palm - Vec3(0.0, 0.055, 0.0), Quat::Identity()},
                         {},
                         shapes.add_box(Vec3(0.2, 0.05, 0.2))});
        return palm - test::mirrored(tuning.hand.palm_center_m);
    }

    const Grab& grab(HandSide side = HandSide::right) const {
        return world.grab.at(players[k_holder].hands[index_of(side)]);
    }
};

Vec3 wave(double t) { return 0.2 * ease(t, 0.2, 0.7) * Vec3(0.0, std::sin(4.0 * t), -1.0); }

TEST(PlayerGrip, GrippingAHeadMovesNeitherPlayer) {
    Pair pair;
    pair.drop_caches();
    pair.run(0.5, [&] {
        for (const std::size_t i : {k_holder, k_held}) {
            ASSERT_LE(pair.origin(i).norm(), 1e-5);  // 0.01 mm
            ASSERT_LE(pair.velocity(i).norm(), 1e-6);
        }
    });
    EXPECT_EQ(pair.grab().kind, GripKind::player);
    EXPECT_EQ(pair.grab().body, pair.players[k_held].player);
    EXPECT_EQ(pair.world.grab.at(pair.players[k_held].hands[0]).kind, GripKind::none);
}

// Two players fly apart and are connected by the grip: afterwards both have the mass-weighted mean
// of their velocities.
TEST(PlayerGrip, SharesMomentumByTheMasses) {
    Pair pair(90.0, 60.0);
    pair.drop_caches();
    pair.velocity(k_held) = Vec3(0.0, 0.05, 0.0);
    const Vec3 before = pair.momentum();
    pair.run(0.6, [&] {
        ASSERT_LE((pair.momentum() - before).norm(), 1e-9 * before.norm());
        ASSERT_LE(pair.grab().error_m, 1e-6);
    });
    const Vec3 shared = before / 150.0;
    EXPECT_LE((pair.velocity(k_holder) - shared).norm(), 1e-8);
    EXPECT_LE((pair.velocity(k_held) - shared).norm(), 1e-8);
}

// Waving the other player moves both about their centre of mass, which stays.
TEST(PlayerGrip, HandMovesBothAboutTheirCentreOfMass) {
    Pair pair(90.0, 60.0);
    pair.move_hand(wave);
    pair.drop_caches();
    double farthest_m = 0.0;
    pair.run(2.0, [&] {
        const Vec3 center = (90.0 * pair.origin(k_holder) + 60.0 * pair.origin(k_held)) / 150.0;
        ASSERT_LE(center.norm(), 1e-6);
        ASSERT_LE(pair.grab().error_m, 1e-6);
        if (pair.grab().kind == GripKind::player) {
            const Vec3 apart = pair.origin(k_held) - pair.origin(k_holder);
            ASSERT_LE((apart - wave(pair.t_s())).norm(), 1e-5) << pair.t_s();
            farthest_m = std::max(farthest_m, apart.norm());
        }
    });
    EXPECT_GT(farthest_m, 0.2);
}

TEST(PlayerGrip, PlayerOnAWallCarriesTheOther) {
    Pair pair;
    pair.move_hand(wave);
    const Vec3 hand = pair.add_wall_under_left_palm();
    pair.scripts[k_holder].hands[index_of(HandSide::left)] = [=](double) {
        return Pose{hand, Quat::Identity()};
    };
    pair.scripts[k_holder].grabs[index_of(HandSide::left)] = [](double t) { return t > 0.05; };
    pair.drop_caches();
    pair.run(2.0, [&] {
        ASSERT_LE(pair.origin(k_holder).norm(), 1e-6);
        ASSERT_LE(pair.grab().error_m, 1e-6);
    });
    EXPECT_EQ(pair.grab(HandSide::left).kind, GripKind::surface);
    EXPECT_EQ(pair.grab().kind, GripKind::player);
    EXPECT_LE((pair.origin(k_held) - wave(pair.t_s())).norm(), 1e-5);
}

// A player grips the head of another who climbs at up to 5 m/s^2, with a hand that moves along:
// both hands' targets can be met without moving the climber off their path, or the holder at all.
TEST(PlayerGrip, ClosingOnAClimbersHeadMovesNeither) {
    Pair pair;
    const auto way = [](double t) { return Vec3(0.0, 0.05 * (1.0 - std::cos(10.0 * t)), 0.0); };
    pair.move_hand(way);
    const Vec3 hand = pair.add_wall_under_left_palm();
    DeviceScript& climber = pair.scripts[k_held];
    climber.hands[index_of(HandSide::left)] = [=](double t) {
        return Pose{hand - way(t), Quat::Identity()};
    };
    climber.grabs[index_of(HandSide::left)] = [](double) { return true; };
    pair.hold_until(1e9);
    pair.drop_caches();
    Vec3 path_error = Vec3::Zero();
    pair.run(0.5, [&] {
        const Vec3 now = pair.origin(k_held) - way(pair.t_s());
        if (pair.t_s() > 0.05) {  // the climber holds the wall by then
            ASSERT_LE((now - path_error).norm(), 1e-5) << pair.t_s();
        }
        path_error = now;
        ASSERT_LE(pair.origin(k_holder).norm(), 1e-5) << pair.t_s();
    });
    EXPECT_EQ(pair.grab().kind, GripKind::player);
    EXPECT_EQ(pair.world.grab.at(pair.players[k_held].hands[0]).kind, GripKind::surface);
}

// The hand follows the head, not the play space: leaning takes the hand along.
TEST(PlayerGrip, HandStaysOnAHeadThatLeans) {
    Pair pair;
    const auto upright = pair.scripts[k_held].head;
    const auto lean = [](double t) { return Vec3(0.1 * ease(t, 0.3, 0.8), 0.0, 0.0); };
    pair.scripts[k_held].head = [=](double t) {
        return Pose{upright(t).position + lean(t),
                    rotation_about(Vec3::UnitZ(), -0.5 * ease(t, 0.3, 0.8))};
    };
    pair.drop_caches();
    Vec3 on_head = Vec3::Zero();
    pair.run(1.2, [&] {
        const Pose& head_ws = pair.world.render_pose.at(pair.players[k_held].player).head_ws;
        const Vec3 hand_ws = pair.world.render_pose.at(pair.players[k_holder].player)
                                 .hands[index_of(HandSide::right)]
                                 .tracked_ws.position;
        const Vec3 now = inverse_transform_point(head_ws, hand_ws);
        if (pair.t_s() > 0.2 && pair.t_s() < 0.25) {
            on_head = now;
        } else if (pair.t_s() > 0.25) {
            ASSERT_LE((now - on_head).norm(), 1e-6);
        }
        ASSERT_LE((pair.origin(k_holder) + pair.origin(k_held)).norm(), 1e-6);
    });
    EXPECT_GT(pair.origin(k_holder).norm(), 0.03);
}

// The hand pushes at 1 m/s as it opens: they separate at that speed, by their masses.
TEST(PlayerGrip, PushingOffPartsThemAtTheHandsSpeed) {
    constexpr double k_release_s = 0.5;
    Pair pair(90.0, 60.0);
    pair.move_hand([](double t) { return Vec3(0.0, 0.0, -1.0 * std::max(0.0, t - 0.3)); });
    pair.hold_until(k_release_s);
    pair.drop_caches();
    pair.run(0.8, [&] { ASSERT_LE(pair.momentum().norm(), 1e-7); });
    EXPECT_EQ(pair.grab().kind, GripKind::none);
    EXPECT_LE((pair.velocity(k_held) - pair.velocity(k_holder) - Vec3(0.0, 0.0, -1.0)).norm(),
              1e-3);
}

TEST(PlayerGrip, EndsIfTheOtherPlayerIsDestroyed) {
    Pair pair;
    pair.drop_caches();
    pair.run(0.3);
    ASSERT_EQ(pair.grab().kind, GripKind::player);
    destroy(pair.world, pair.players[k_held].player);
    std::array<TrackingSample, 1> samples = {sample_of(pair.scripts[k_holder], pair.t_s())};
    const std::array inputs = {PlayerInput{pair.players[k_holder].player, samples, {}}};
    step_frame(pair.world, *pair.caches, pair.tuning, {Pair::k_step_s, inputs}, pair.stats);
    EXPECT_EQ(pair.grab().kind, GripKind::none);
    EXPECT_EQ(pair.stats.fallbacks[static_cast<std::size_t>(Fallback::grip_body_gone)], 1U);
}

}  // namespace
}  // namespace handhold::scenario_player_grip_test
