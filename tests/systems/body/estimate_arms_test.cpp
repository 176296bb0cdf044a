#include "systems/body/estimate_arms.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "systems/body/pose_arms.hpp"
#include "systems/body/shared/elbow_direction.hpp"
#include "systems/body/shared/level_direction.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::estimate_arms_test {
namespace {

using test::k_left;
using test::k_player;
using test::k_right;
using test::mirrored;
using test::Random;

// Columns of one player; head and hands in play space.
struct Arms {
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<PalmPose> palm;
    Column<ArmMemory> memory;
    Column<ArmEstimate> estimate;
    Column<ArmPose> pose;
    ArmTuning tuning;

    explicit Arms(const Pose& origin_ws = {}) {
        origin.add(k_player, {origin_ws});
        head.add(k_player);
        measures.add(k_player);
        memory.add(k_player);
        estimate.add(k_player);
        pose.add(k_player);
        owner.add(k_left, {k_player, HandSide::left});
        owner.add(k_right, {k_player, HandSide::right});
        palm.add(k_left);
        palm.add(k_right);
    }
    const ArmPose& step(const Pose& head_ps, const Pose& left_ps, const Pose& right_ps,
                        double dt_s = 1.0 / 90.0) {
        const Pose& at = origin.at(k_player).pose_ws;
        head.at(k_player).pose_ps = head_ps;
        palm.at(k_left).pose_ws = at * left_ps;
        palm.at(k_right).pose_ws = at * right_ps;
        estimate_arms({.dt_s = dt_s,
                       .origin = origin,
                       .head = head,
                       .measures = measures,
                       .owner = owner,
                       .palm = palm,
                       .memory = memory,
                       .estimate = estimate},
                      tuning);
        pose_arms({.origin = origin,
                   .measures = measures,
                   .owner = owner,
                   .palm = palm,
                   .estimate = estimate,
                   .arms = pose});
        return pose.at(k_player);
    }
};

constexpr double k_float_noise_m = 1e-5;  // the networks are evaluated in floats

const Pose k_head{Vec3(0.0, 1.62, 0.0), Quat::Identity()};
const Pose k_left_hand{Vec3(-0.25, 1.2, -0.3), Quat::Identity()};
const Pose k_right_hand{Vec3(0.25, 1.2, -0.3), Quat::Identity()};

Pose turned(const Pose& pose, double yaw_rad) {
    return Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), yaw_rad)} * pose;
}
Vec3 elbow(const ArmPose& pose, std::size_t side) { return pose.arms[side].forearm_ws.position; }

TEST(EstimateArms, SymmetricHandsKeepTheChestFacingTheLookDirection) {
    Arms arms;
    arms.step(k_head, k_left_hand, k_right_hand);
    EXPECT_LT((arms.estimate.at(k_player).facing_ps + Vec3::UnitZ()).norm(), 1e-12);
}

TEST(EstimateArms, HandJointEqualsThePalmExactly) {
    Random random(3);
    Arms arms({Vec3(1e4, -7.0, 3.0), random.rotation()});
    for (int i = 0; i < 200; ++i) {
        const Pose head = random.pose(1.0);
        const Pose left = random.pose(1.5);
        const ArmPose& pose = arms.step(head, left, random.pose(1.5));
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Pose& palm = arms.palm.elements()[side].pose_ws;
            EXPECT_EQ(pose.arms[side].hand_ws.position, palm.position);
            EXPECT_EQ(pose.arms[side].hand_ws.rotation.coeffs(), palm.rotation.coeffs());
        }
    }
}

TEST(EstimateArms, MirroredPlayerHasMirroredArms) {
    Random random(5);
    Arms arms;
    Arms mirror;
    for (int i = 0; i < 100; ++i) {
        const Pose head{k_head.position + random.vector(0.05), random.rotation()};
        const Pose left = random.pose(1.0);
        const Pose right = random.pose(1.0);
        const ArmPose& a = arms.step(head, left, right);
        const ArmPose& b = mirror.step(mirrored(head), mirrored(right), mirrored(left));
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            EXPECT_EQ(mirrored(elbow(a, side)), elbow(b, 1 - side));
        }
    }
}

TEST(EstimateArms, TurnedPlaySpaceTurnsTheWholeEstimate) {
    Arms arms;
    Arms other;
    for (int i = 0; i < 50; ++i) {
        const double sway = 0.1 * std::sin(0.2 * i);
        const Pose left{k_left_hand.position + Vec3(0.0, sway, sway), k_left_hand.rotation};
        const ArmPose& a = arms.step(k_head, left, k_right_hand);
        const ArmPose& b =
            other.step(turned(k_head, 2.0), turned(left, 2.0), turned(k_right_hand, 2.0));
        const Quat turn = rotation_about(Vec3::UnitY(), 2.0);
        EXPECT_LT((turn * elbow(a, 0) - elbow(b, 0)).norm(), k_float_noise_m);
    }
}

TEST(EstimateArms, PlayerUpsideDownHasTheSameArms) {
    Arms upright;
    Arms hanging({Vec3(3.0, 20.0, -5.0), rotation_about(Vec3::UnitZ(), k_pi)});
    const ArmPose& a = upright.step(k_head, k_left_hand, k_right_hand);
    const ArmPose& b = hanging.step(k_head, k_left_hand, k_right_hand);
    EXPECT_LT(
        (transform_point(hanging.origin.at(k_player).pose_ws, elbow(a, 1)) - elbow(b, 1)).norm(),
        k_float_noise_m);
}

TEST(EstimateArms, SteadyHeadTurnLagsEquallyAtAnyFrameRate) {
    const double speed_radps = 0.8;
    for (const double hz : {30.0, 90.0, 144.0}) {
        Vec3 look = -Vec3::UnitZ();
        double yaw = 0.0;
        for (int i = 0; i < static_cast<int>(4.0 * hz); ++i) {
            yaw += speed_radps / hz;
            const Vec3 now(-std::sin(yaw), 0.0, -std::cos(yaw));
            look = follow_look(look, now, follow_share(1.0 / hz, 0.3));
        }
        const double lag = std::remainder(yaw - std::atan2(-look.x(), -look.z()), 2.0 * k_pi);
        EXPECT_NEAR(lag, speed_radps * 0.3, 1e-4) << hz;
    }
}

TEST(EstimateArms, HandOutOfReachMovesTheShoulderThenStretchesTheArm) {
    const ArmTuning tuning;
    EXPECT_EQ(shoulder_follow(Vec3(0.0, 0.0, -0.5), 0.58, 0.0, tuning), Vec3::Zero());
    const Vec3 some = shoulder_follow(Vec3(0.0, 0.0, -0.60), 0.58, 0.0, tuning);
    EXPECT_NEAR(-some.z(), 0.60 - 0.58 * tuning.reach, 1e-12);
    const Vec3 most = shoulder_follow(Vec3(0.0, 0.0, -3.0), 0.58, 0.0, tuning);
    EXPECT_NEAR(-most.z(), tuning.shoulder_follow_m, 1e-12);
}

// Clavicle and reach together lift a shoulder less than 8 cm, so it stays below the head.
TEST(EstimateArms, ShouldersLeaveTheirRestByABoundedDistance) {
    Random random(13);
    const ArmTuning tuning;
    const double arm_m = 0.58;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 hand_m = random.arm(0.0, 2.0 * arm_m);
        const Vec3 clavicle_m = clavicle_shift(hand_m / arm_m, tuning);
        const Vec3 follow_m =
            shoulder_follow(hand_m - clavicle_m, arm_m, clavicle_m.norm(), tuning);
        ASSERT_LT((clavicle_m + follow_m).norm(), 0.08) << hand_m.transpose();
    }
}

// The head turns about its ears while chest and hands stay where they are in the room.
TEST(EstimateArms, LookingUpHardlyMovesTheShoulders) {
    const Vec3 ears = k_head.position + Vec3(0.0, -0.05, 0.08);
    const auto looking_up = [&](double pitch_rad) {
        const Quat turn = rotation_about(Vec3::UnitX(), pitch_rad);
        return Pose{ears + turn * (k_head.position - ears), (turn * k_head.rotation).normalized()};
    };
    const auto chest = [&](double pitch_rad) {
        Arms arms;
        return arms.step(looking_up(pitch_rad), k_left_hand, k_right_hand).chest_ws.position;
    };
    const Vec3 level = chest(0.0);
    Vec3 before = level;
    for (int degrees = 2; degrees <= 88; degrees += 2) {
        const Vec3 now = chest(degrees * k_pi / 180.0);
        EXPECT_LT(now.y() - level.y(), 0.04) << degrees;
        EXPECT_LT((now - level).norm(), 0.09) << degrees;
        EXPECT_LT((now - before).norm(), 0.008) << degrees;
        before = now;
    }
}

// Oracle: a search over the whole circle.
TEST(EstimateArms, ReachableBendIsTheClosestDirectionInsideTheCone) {
    Random random(17);
    const ArmTuning tuning;
    for (int i = 0; i < 300; ++i) {
        const Vec3 axis = random.direction();
        const ElbowCircle circle = elbow_circle(random.between(0.02, 0.57), axis, 0.30, 0.28);
        const Vec3 square = axis.cross(random.direction()).normalized();
        const HandSide side = i % 2 == 0 ? HandSide::right : HandSide::left;
        Vec3 cone = tuning.elbow_cone.normalized();
        cone.x() *= side == HandSide::right ? 1.0 : -1.0;
        const auto inside_by = [&](const Vec3& bend) {
            return (circle.middle_ts + circle.radius_m * bend).dot(cone) / 0.30 -
                   tuning.elbow_cone_cosine;
        };
        const Vec3 bend = reachable_bend(circle, square, side, tuning);
        EXPECT_NEAR(bend.norm(), 1.0, 1e-9);
        EXPECT_NEAR(bend.dot(axis), 0.0, 1e-9);
        double most_inside = -10.0;
        double nearest = -1.0;
        for (int k = 0; k < 720; ++k) {
            const double angle = k * 2.0 * k_pi / 720.0;
            const Vec3 other =
                std::cos(angle) * square + std::sin(angle) * Vec3(axis.cross(square));
            most_inside = std::max(most_inside, inside_by(other));
            if (inside_by(other) >= 0.0) {
                nearest = std::max(nearest, other.dot(square));
            }
        }
        if (most_inside < 0.0) {
            EXPECT_NEAR(inside_by(bend), most_inside, 1e-4);
        } else {
            EXPECT_GT(inside_by(bend), -1e-9);
            EXPECT_GT(bend.dot(square), nearest - 1e-9);
        }
    }
}

// Hands metres away resemble no data: the networks must not be heard.
TEST(EstimateArms, UnfamiliarHandsGiveTheTalksForm) {
    Random random(23);
    for (int i = 0; i < 200; ++i) {
        Arms learned;
        Arms talked;
        talked.tuning.learned = 0.0;
        const Pose left{k_head.position + 4.0 * random.direction(), random.rotation()};
        const Pose right{k_head.position + 4.0 * random.direction(), random.rotation()};
        learned.step(k_head, left, right);
        talked.step(k_head, left, right);
        const ArmEstimate& a = learned.estimate.at(k_player);
        const ArmEstimate& b = talked.estimate.at(k_player);
        EXPECT_EQ(a.facing_ps, b.facing_ps);
        EXPECT_EQ(a.chest_ps.position, b.chest_ps.position);
        EXPECT_EQ(a.arms[0].bend_ps, b.arms[0].bend_ps);
        EXPECT_EQ(a.arms[1].bend_ps, b.arms[1].bend_ps);
    }
}

// A hand that moves out of the data's range, one millimetre at a time.
TEST(EstimateArms, ChestFadesToTheTalksFormWithoutAJump) {
    const auto facing = [](double ahead_m) {
        Arms arms;
        arms.step(k_head, k_left_hand, {Vec3(0.25, 1.2, -ahead_m), Quat::Identity()});
        return arms.estimate.at(k_player).facing_ps;
    };
    Vec3 before = facing(0.3);
    for (int i = 301; i < 5000; ++i) {
        const Vec3 now = facing(0.001 * i);
        ASSERT_LT((now - before).norm(), 0.02) << i;
        before = now;
    }
}

// Smooth hand paths through all singular positions: the elbow moves at most a few times as fast as
// the hand, and all numbers are finite.
TEST(EstimateArms, ElbowsStayContinuousThroughSingularHandPositions) {
    for (const double hz : {30.0, 72.0, 90.0, 144.0}) {
        Arms arms;
        Vec3 before[k_hand_count];
        for (int i = 0; i < static_cast<int>(12.0 * hz); ++i) {
            const double t = i / hz;
            // Circles of changing radius about each shoulder: crossed, behind, at full reach and at
            // the shoulder, at human speed.
            const auto hand = [t](double side) {
                const double size = 0.36 + 0.35 * std::sin(0.4 * t + side);
                return Pose{Vec3(0.19 * side + size * std::sin(1.1 * t),
                                 1.4 + size * std::sin(0.7 * t + 1.0), size * std::cos(1.1 * t)),
                            rotation_about(Vec3::UnitY(), 0.5 * std::sin(t))};
            };
            const ArmPose& pose = arms.step(k_head, hand(-1.0), hand(1.0), 1.0 / hz);
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                ASSERT_TRUE(is_finite(elbow(pose, side)));
                if (i > 0) {
                    ASSERT_LT((elbow(pose, side) - before[side]).norm() * hz, 9.0)
                        << "at " << t << " s, " << hz << " Hz";
                }
                before[side] = elbow(pose, side);
            }
        }
    }
}

TEST(EstimateArms, TeleportsAndExtremeInputStayFinite) {
    Random random(11);
    Arms arms;
    for (int i = 0; i < 2000; ++i) {
        const double size = i % 7 == 0 ? 1e4 : 0.8;
        const Pose head = random.pose(size);
        const Pose left = i % 3 == 0 ? head : random.pose(size);
        const ArmPose& pose = arms.step(head, left, random.pose(size), i % 5 == 0 ? 10.0 : 0.01);
        for (const ArmPose::Arm& arm : pose.arms) {
            ASSERT_TRUE(is_valid(arm.clavicle_ws) && is_valid(arm.upper_ws) &&
                        is_valid(arm.forearm_ws));
        }
    }
}

}  // namespace
}  // namespace handhold::estimate_arms_test
