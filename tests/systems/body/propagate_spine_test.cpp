#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::propagate_spine_test {
namespace {

using test::k_player;

struct Body {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<BodyMeasures> measures;
    Column<ArmEstimate> estimate;
    Column<HeadTracking> head;
    Column<SpineMemory> memory;
    Column<PersistentId> no_ids;
    Column<HandOwner> no_hands;
    Column<Grab> no_grips;
    Column<BodyHold> no_holds;
    Column<SpinePose> pose;
    SpineTuning tuning;
    double t_s = 0.0;

    Body() {
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        head.add(k_player);
        measures.add(k_player);
        estimate.add(k_player);
        memory.add(k_player);
        pose.add(k_player);
        estimate.at(k_player).chest_ps.position = Vec3(0.0, 1.4, 0.0);
    }
    // Moves the player at this velocity for dt_s.
    const SpinePose& step(const Vec3& velocity_mps, double dt_s) {
        origin.at(k_player).pose_ws.position += dt_s * velocity_mps;
        velocity.at(k_player).linear_mps = velocity_mps;
        t_s += dt_s;
        propagate_spine({.dt_s = dt_s,
                         .t_s = t_s,
                         .surfaces = {},
                         .persistent_id = no_ids,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .head = head,
                         .measures = measures,
                         .estimate = estimate,
                         .owner = no_hands,
                         .grab = no_grips,
                         .body_hold = no_holds,
                         .memory = memory,
                         .pose = pose},
                        tuning);
        return pose.at(k_player);
    }
    Vec3 foot_from_chest(std::size_t side = 1) const {
        const SpinePose& p = pose.at(k_player);
        return p.legs[side].foot_ws.position - p.chest_ws.position;
    }
};

// Speed along -Z: accelerates to 2.5 m/s in 0.5 s, coasts for 1 s, brakes within 0.2 s.
double speed_at(double t_s) {
    return -2.5 * (smooth_step(t_s, 0.0, 0.5) - smooth_step(t_s, 1.5, 1.7));
}
TEST(PropagateSpine, RestPoseIsStationary) {
    Body body;
    const Vec3 first = (body.step(Vec3::Zero(), 1.0 / 90.0), body.foot_from_chest());
    for (int i = 0; i < 900; ++i) {
        body.step(Vec3::Zero(), 1.0 / 90.0);
    }
    EXPECT_LT((body.foot_from_chest() - first).norm(), 1e-9);
}

TEST(PropagateSpine, LegsTrailOvershootAndSettle) {
    Body body;
    const double hz = 90.0;
    const Vec3 rest = (body.step(Vec3::Zero(), 1.0 / hz), body.foot_from_chest());
    double most_behind = 0.0;
    double most_ahead = 0.0;
    for (int i = 1; i <= static_cast<int>(7.0 * hz); ++i) {
        body.step(Vec3(0.0, 0.0, speed_at(i / hz)), 1.0 / hz);
        const double z = body.foot_from_chest().z() - rest.z();
        (i / hz < 1.5 ? most_behind : most_ahead) =
            i / hz < 1.5 ? std::max(most_behind, z) : std::min(most_ahead, z);
    }
    EXPECT_GT(most_behind, 0.3);  // behind is +Z
    EXPECT_LT(most_ahead, -0.1);
    EXPECT_LT((body.foot_from_chest() - rest).norm(), 0.03);
}

// Accelerates, brakes, then pitches the chest. The chest's pose at each frame's end is exact.
struct Way {
    std::vector<double> z_m;
    explicit Way(std::size_t hz, double for_s)
        : z_m(static_cast<std::size_t>(for_s * 10) * hz / 10) {
        constexpr int k_parts = 16;
        for (std::size_t i = 1; i < z_m.size(); ++i) {
            z_m[i] = z_m[i - 1];
            for (int part = 0; part < k_parts; ++part) {
                const double steps = static_cast<double>(i - 1) + (part + 0.5) / k_parts;
                z_m[i] +=
                    speed_at(steps / static_cast<double>(hz)) / (k_parts * static_cast<double>(hz));
            }
        }
    }
};
double pitch_at(double t_s) {
    return 0.6 * (smooth_step(t_s, 2.5, 2.9) - smooth_step(t_s, 3.4, 3.8));
}
// Position of the right foot from the chest, sampled at 36 Hz; `hz` is a multiple of 36.
std::vector<Vec3> feet_at(std::size_t hz, double starts_s) {
    const double dt_s = 1.0 / static_cast<double>(hz);
    const Way way(hz, 6.0);
    Body body;
    body.t_s = starts_s - dt_s;
    body.step(Vec3::Zero(), dt_s);
    std::vector<Vec3> feet;
    for (std::size_t i = 1; i < way.z_m.size(); ++i) {
        body.estimate.at(k_player).chest_ps.rotation =
            rotation_about(Vec3::UnitX(), -pitch_at(static_cast<double>(i) * dt_s));
        body.step(Vec3(0.0, 0.0, (way.z_m[i] - way.z_m[i - 1]) / dt_s), dt_s);
        if (i % (hz / 36) == 0) {
            feet.push_back(body.foot_from_chest());
        }
    }
    return feet;
}
double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        worst = std::max(worst, (a[i] - b[i]).norm());
    }
    return worst;
}

TEST(PropagateSpine, MotionIsIndependentOfTheFrameRate) {
    const std::vector<Vec3> fast = feet_at(144, 3.0);
    EXPECT_LT(farthest(feet_at(36, 3.0), fast), 0.01);
    EXPECT_LT(farthest(feet_at(72, 3.0), fast), 0.01);
    EXPECT_LT(farthest(feet_at(720, 3.0), fast), 0.01);
}

TEST(PropagateSpine, MotionHardlyDependsOnThePhaseOfTheTicks) {
    // Later on the world clock by a third and by a half of a tick.
    const std::vector<Vec3> feet = feet_at(144, 3.0);
    EXPECT_LT(farthest(feet_at(144, 3.0 + 1.0 / 360.0), feet), 0.01);
    EXPECT_LT(farthest(feet_at(144, 3.0 + 1.0 / 240.0), feet), 0.01);
}

TEST(PropagateSpine, LinksApproachTheirLimitsGradually) {
    Body body;
    const SpineTuning& tuning = body.tuning;
    const double share = 1.0 / (1.0 + 120.0 * tuning.limit_lag_s);
    std::array<double, k_body_links> before{};
    double most = 0.0;
    for (int i = 0; i < 600; ++i) {
        // One tick per frame.
        body.step(Vec3(0.0, 1.5 * std::cos(0.03 * i), 3.0 * std::sin(0.1 * i)), 1.0 / 120.0);
        const std::array<double, k_body_links>& now = body.memory.at(k_player).angle_rad;
        for (std::size_t link = 0; i > 1 && link < k_spine_links; ++link) {
            EXPECT_LE(now[link],
                      std::max(before[link],
                               before[link] + share * (tuning.spine_limit_rad - before[link])) +
                          1e-12);
            most = std::max(most, now[link]);
        }
        before = now;
    }
    EXPECT_GT(most, 0.95 * tuning.spine_limit_rad);
}

TEST(PropagateSpine, BonesKeepTheirLengthsAndKneesBendOnlyBackwards) {
    Body body;
    const double scale = BodyMeasures{}.eye_height_m / 1.6;
    for (int i = 0; i < 600; ++i) {
        const Vec3 velocity(3.0 * std::sin(0.11 * i), 2.0 * std::cos(0.07 * i),
                            4.0 * std::sin(0.05 * i));
        const SpinePose& pose = body.step(velocity, 1.0 / 90.0);
        for (const SpinePose::Leg& leg : pose.legs) {
            const Vec3 thigh = leg.shin_ws.position - leg.thigh_ws.position;
            const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
            EXPECT_NEAR(thigh.norm(), 0.40 * scale, 1e-9);
            EXPECT_NEAR(shin.norm(), 0.39 * scale, 1e-9);
            // Bent backwards, about the thigh's X axis, by at most the limit. Interpolation between
            // ticks adds up to a degree.
            const Vec3 in_thigh = leg.thigh_ws.rotation.conjugate() * shin.normalized();
            EXPECT_GT(in_thigh.z(), -0.02);
            EXPECT_LT(std::atan2(in_thigh.z(), -in_thigh.y()), body.tuning.knee_limit_rad + 0.03);
        }
    }
}

TEST(PropagateSpine, ReferenceVelocityOfAFastShipHasNoEffect) {
    Body still;
    Body carried;
    carried.reference.at(k_player).linear_mps = Vec3(1000.0, 0.0, 0.0);
    for (int i = 0; i < 300; ++i) {
        const Vec3 own(0.0, 0.0, -1.5 * std::sin(0.05 * i));
        still.step(own, 1.0 / 90.0);
        carried.step(own + Vec3(1000.0, 0.0, 0.0), 1.0 / 90.0);
        EXPECT_LT((still.foot_from_chest() - carried.foot_from_chest()).norm(), 1e-6);
    }
}

TEST(PropagateSpine, PelvisFollowsATurnOfTheChestWithALag) {
    Body body;
    const auto heading = [&body] {
        const Vec3 ahead = body.pose.at(k_player).pelvis_ws.rotation * -Vec3::UnitZ();
        return std::atan2(-ahead.x(), -ahead.z());
    };
    body.step(Vec3::Zero(), 1.0 / 90.0);
    Quat& chest = body.estimate.at(k_player).chest_ps.rotation;
    for (int i = 1; i <= 45; ++i) {
        chest = rotation_about(Vec3::UnitY(), i / 45.0 * 0.8);
        body.step(Vec3::Zero(), 1.0 / 90.0);
    }
    // A steady turn of 1.6 rad/s: each of three links lags by twist_lag_s in steady state.
    EXPECT_GT(heading(), 0.8 - 1.6 * 3.0 * body.tuning.twist_lag_s - 0.02);
    EXPECT_LT(heading(), 0.8 - 0.25);
    for (int i = 0; i < 270; ++i) {
        body.step(Vec3::Zero(), 1.0 / 90.0);
    }
    EXPECT_NEAR(heading(), 0.8, 0.01);
}

TEST(PropagateSpine, TeleportsAndLongFramesKeepBodiesValid) {
    Body body;
    for (int i = 0; i < 200; ++i) {
        if (i % 20 == 0) {
            body.estimate.at(k_player).chest_ps.position += Vec3(1e5, 0.0, 3.0);
        }
        const SpinePose& pose = body.step(Vec3(1e6, -1e3, 5.0 * i), i % 9 == 0   ? 10.0
                                                                    : i % 5 == 0 ? 1e-6
                                                                                 : 0.01);
        for (const SpinePose::Leg& leg : pose.legs) {
            ASSERT_TRUE(is_valid(leg.thigh_ws) && is_valid(leg.foot_ws));
        }
        ASSERT_LT(body.foot_from_chest().norm(), 1.6);
    }
}

}  // namespace
}  // namespace handhold::propagate_spine_test
