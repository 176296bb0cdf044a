// In zero-G, the trunk hangs from the gripping hands.
#include "systems/body/shared/hang_body.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::hang_body_test {
namespace {

using test::HangingBody;
using test::joints_of;
using test::k_player;
using test::Random;

double angle_rad(const Vec3& a, const Vec3& b) { return arc_tangent2(a.cross(b).norm(), a.dot(b)); }
Vec3 trunk_of(const SpinePose& pose) { return pose.pelvis_ws.position - pose.chest_ws.position; }

// A direction above the horizontal, for a gripping hand.
Vec3 upper_direction(Random& random) {
    Vec3 d = random.direction();
    return {d.x(), std::abs(d.y()), d.z()};
}

TEST(HangBody, HandsThatPullOnNothingChangesNoBit) {
    HangingBody still;
    HangingBody waving;
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        waving.put_hand(HandSide::left, 0.6 * random.direction());
        waving.grab.at(test::k_right).kind = i % 2 == 0 ? GripKind::held : GripKind::none;
        const std::vector<Vec3> a = joints_of(still.step(1.0 / 90.0));
        const std::vector<Vec3> b = joints_of(waving.step(1.0 / 90.0));
        EXPECT_EQ(a, b);
    }
}

// The closed form of lean_of, for pulls up to 80 degrees from the posture: the trunk's lower
// link turns by a p.
TEST(HangBody, LowestLinkTurnsByItsShareOfTheAngle) {
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        const Vec3 direction = upper_direction(random);
        const Vec3 pull = random.between(0.0, 1.0) * direction;
        if (angle_rad(pull, Vec3::UnitY()) > 80.0 / 180.0 * k_pi) {
            continue;
        }
        const TrunkLean lean = lean_of(pull);
        Quat frame = leaning_chest(Quat::Identity(), lean);
        Vec3 down = -Vec3::UnitY();
        for (const Vec3& rest : lean.rest_above) {
            down = frame * rest;
            frame = frame * rotation_between(-Vec3::UnitY(), rest);
        }
        const double turned = angle_rad(down, -Vec3::UnitY());
        EXPECT_NEAR(turned, angle_rad(pull, Vec3::UnitY()) * pull.norm(), 0.05);
    }
}

TEST(HangBody, LeanIsContinuousInThePull) {
    Random random(5);
    const auto lowest = [](const TrunkLean& lean) {
        return Vec3(lean.rest_above[0] + lean.rest_above[1] + lean.rest_above[2] +
                    Vec3(lean.chest_rad, 0.0, 0.0));
    };
    for (int i = 0; i < 2000; ++i) {
        const Vec3 pull = random.arm(0.2, 1.0);
        const Vec3 near = pull + 1e-4 * random.direction();
        EXPECT_LT((lowest(lean_of(pull)) - lowest(lean_of(near))).norm(), 4e-3);
    }
    // Straight up and straight down, in whose neighbourhood the axis is undefined.
    for (const double y : {-0.9, 0.9}) {
        const Vec3 near(1e-4, y, -1e-4);
        EXPECT_LT((lowest(lean_of({0.0, y, 0.0})) - lowest(lean_of(near))).norm(), 4e-3);
    }
}

TEST(HangBody, TrunkTurnsTowardsTheOppositeOfTheGrippingHand) {
    Random random(7);
    for (int i = 0; i < 20; ++i) {
        HangingBody body;
        const Vec3 up = upper_direction(random);
        const HandSide side = i % 2 == 0 ? HandSide::left : HandSide::right;
        body.put_hand(side, body.arm_m() * up);
        const Vec3 before = trunk_of(body.run(0.5));
        body.grip(side, true);
        const Vec3 after = trunk_of(body.run(5.0));
        EXPECT_LT(angle_rad(after, -up), 0.85 * angle_rad(before, -up) + 0.02) << i;
        // It comes back.
        body.grip(side, false);
        EXPECT_LT((trunk_of(body.run(8.0)) - before).norm(), 0.01);
    }
}

TEST(HangBody, ChestStaysWhereHeadAndHandsHaveIt) {
    HangingBody body;
    body.put_hand(HandSide::left, Vec3(0.1, 0.2, -0.5));
    body.grip(HandSide::left, true);
    for (int i = 0; i < 200; ++i) {
        EXPECT_EQ(body.step(1.0 / 90.0).chest_ws.position,
                  body.estimate.at(k_player).chest_ps.position);
    }
}

TEST(HangBody, MirroredPlayersHangMirrored) {
    Random random(13);
    HangingBody body;
    HangingBody mirror;
    for (int i = 0; i < 300; ++i) {
        const Vec3 hand{random.between(-0.5, 0.2), random.between(-0.4, 0.5),
                        random.between(-0.5, 0.3)};
        body.put_hand(HandSide::left, hand);
        mirror.put_hand(HandSide::right, test::mirrored(hand));
        body.grip(HandSide::left, i % 60 < 40);
        mirror.grip(HandSide::right, i % 60 < 40);
        const SpinePose& a = body.step(1.0 / 90.0);
        const SpinePose& b = mirror.step(1.0 / 90.0);
        EXPECT_LT((a.pelvis_ws.position - test::mirrored(b.pelvis_ws.position)).norm(), 1e-9);
        EXPECT_LT((a.legs[0].foot_ws.position - test::mirrored(b.legs[1].foot_ws.position)).norm(),
                  1e-9);
    }
}

TEST(HangBody, TurnedAndMovedWorldsGiveTurnedAndMovedBodies) {
    Random random(17);
    HangingBody body;
    HangingBody turned;
    const Pose world = random.pose();
    turned.origin.at(k_player).pose_ws = world;
    for (int i = 0; i < 200; ++i) {
        const Vec3 hand = body.arm_m() * upper_direction(random);
        for (HangingBody* one : {&body, &turned}) {
            one->put_hand(HandSide::right, hand);
            one->grip(HandSide::right, i > 20);
        }
        const std::vector<Vec3> a = joints_of(body.step(1.0 / 90.0));
        const std::vector<Vec3> b = joints_of(turned.step(1.0 / 90.0));
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_LT((transform_point(world, a[k]) - b[k]).norm(), 1e-9);
        }
    }
}

// Grips of straight arms, 90 degrees from the posture, begin and end: the pelvis moves at up to
// 0.5 m/s relative to the chest, feet at up to 2 m/s. In a frame the pelvis changes its velocity by
// at most 0.04 m/s, knees and feet by 0.2 m/s.
TEST(HangBody, GripsBeginAndEndWithoutAJump) {
    HangingBody body;
    body.put_hand(HandSide::left, Vec3(-0.1, 0.05, -0.55));
    body.put_hand(HandSide::right, Vec3(0.1, 0.05, -0.55));
    std::vector<Vec3> before = joints_of(body.run(0.5));
    std::vector<Vec3> velocity(before.size(), Vec3::Zero());
    for (int i = 0; i < 450; ++i) {
        body.grip(HandSide::left, i >= 30 && i < 220);
        body.grip(HandSide::right, i >= 110 && i < 300);
        const std::vector<Vec3> now = joints_of(body.step(1.0 / 90.0));
        for (std::size_t k = 0; k < now.size(); ++k) {
            const Vec3 mps = 90.0 * (now[k] - before[k]);
            EXPECT_LT(mps.norm(), k <= k_spine_links ? 0.5 : 2.0) << i;
            EXPECT_LT((mps - velocity[k]).norm(), k <= k_spine_links ? 0.04 : 0.2) << i;
            velocity[k] = mps;
        }
        before = now;
    }
}

struct Apart {
    double pelvis_m = 0.0;
    double foot_m = 0.0;
};
// Largest distances after `from_s` between bodies at 36 and at 144 frames a second whose hand
// moves, and grips from `begin_s` until `end_s`.
Apart apart_by_rate(double begin_s, double end_s, double from_s) {
    const auto path = [&](int hz) {
        HangingBody body;
        std::vector<Vec3> at_36;
        for (int i = 1; i <= 8 * hz; ++i) {
            const double t_s = static_cast<double>(i) / hz;
            body.put_hand(HandSide::left,
                          Vec3(0.3 * std::sin(2.0 * t_s), 0.3, -0.4 * std::cos(t_s)));
            body.grip(HandSide::left, t_s > begin_s && t_s <= end_s);
            const SpinePose& pose = body.step(1.0 / hz);
            if (i % (hz / 36) == 0 && t_s > from_s) {
                at_36.push_back(pose.pelvis_ws.position);
                at_36.push_back(pose.legs[0].foot_ws.position);
            }
        }
        return at_36;
    };
    const std::vector<Vec3> slow = path(36);
    const std::vector<Vec3> fast = path(144);
    Apart apart;
    for (std::size_t i = 0; i < slow.size(); i += 2) {
        apart.pelvis_m = std::max(apart.pelvis_m, (slow[i] - fast[i]).norm());
        apart.foot_m = std::max(apart.foot_m, (slow[i + 1] - fast[i + 1]).norm());
    }
    return apart;
}

TEST(HangBody, HangingHardlyDependsOnTheFrameRate) {
    const Apart held = apart_by_rate(0.5, 9.0, 5.0);
    RecordProperty("held_pelvis_um", static_cast<int>(1e6 * held.pelvis_m));
    RecordProperty("held_foot_um", static_cast<int>(1e6 * held.foot_m));
    // A grip begins and ends with a frame, which is up to 28 ms long.
    const Apart edges = apart_by_rate(0.5, 2.5, 0.0);
    RecordProperty("edges_pelvis_um", static_cast<int>(1e6 * edges.pelvis_m));
    RecordProperty("edges_foot_um", static_cast<int>(1e6 * edges.foot_m));
    EXPECT_LT(held.pelvis_m, 0.002);
    EXPECT_LT(held.foot_m, 0.008);
    EXPECT_LT(edges.pelvis_m, 0.004);
    EXPECT_LT(edges.foot_m, 0.02);
}

}  // namespace
}  // namespace handhold::hang_body_test
