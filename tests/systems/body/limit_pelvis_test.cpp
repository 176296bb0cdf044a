#include "systems/body/limit_pelvis.hpp"

#include <gtest/gtest.h>

#include "systems/body/limit_feet.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::limit_pelvis_test {
namespace {

using test::k_player;
using test::Random;

constexpr double k_dt_s = 1.0 / 90.0;
constexpr double k_rounding_m = 1e-9;

// A straight trunk with legs, turned about a chest at rest.
struct Trunk {
    Column<PlayerOrigin> origin;
    Column<SpineMemory> memory;
    Column<SpinePose> pose;
    double scale;

    Trunk(const Pose& origin_ws, double scale_) : scale(scale_) {
        origin.add(k_player, {origin_ws, scale});
        memory.add(k_player);
        pose.add(k_player);
    }
    void put(const Quat& turn) {
        const Pose& origin_ws = origin.at(k_player).pose_ws;
        const auto below = [&](double aside_m, double down_m) {
            return origin_ws * Pose{scale * (turn * Vec3(aside_m, -down_m, 0.0)), turn};
        };
        SpinePose& out = pose.at(k_player);
        out.chest_ws = origin_ws;
        double down_m = 0.1;
        for (Pose& link : out.spine_ws) {
            link = below(0.0, down_m);
            down_m += 0.1;
        }
        out.pelvis_ws = below(0.0, 0.5);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double aside_m = side == 0 ? -0.09 : 0.09;
            out.legs[side] = {below(aside_m, 0.5), below(aside_m, 0.9), below(aside_m, 1.3)};
        }
    }
    SpinePose& limit() {
        limit_pelvis({.dt_s = k_dt_s, .origin = origin, .memory = memory, .pose = pose});
        return pose.at(k_player);
    }
    Vec3 pelvis_m() const {
        const SpinePose& shown = pose.at(k_player);
        return (shown.pelvis_ws.position - shown.chest_ws.position) / scale;
    }
};

TEST(LimitPelvis, SlowPelvisIsUnchangedExactly) {
    Random random(5001);
    for (int i = 0; i < 20; ++i) {
        const Pose origin_ws = random.pose(5.0);
        Trunk trunk(origin_ws, random.between(0.1, 10.0));
        const Vec3 axis = random.direction();
        for (int frame = 0; frame < 90; ++frame) {
            trunk.put(rotation_about(axis, 0.4 - 0.4 * sine(0.5 * k_pi + 0.02 * frame)));
            const SpinePose given = trunk.pose.at(k_player);
            const SpinePose& shown = trunk.limit();
            EXPECT_EQ(shown.pelvis_ws.position, given.pelvis_ws.position);
            EXPECT_EQ(shown.legs[1].foot_ws.position, given.legs[1].foot_ws.position);
        }
    }
}

// The trunk is thrown about: its place jumps every 20 frames, and is then kept.
TEST(LimitPelvis, ThrownPelvisKeepsItsLimitsAndBonesAndArrives) {
    Random random(5002);
    constexpr double k_chord = 1.05;  // the limited pelvis moves on a chord, then out to the arc
    int limited = 0;
    for (int i = 0; i < 50; ++i) {
        const Pose origin_ws = random.pose(5.0);
        Trunk trunk(origin_ws, random.between(0.1, 10.0));
        trunk.put(Quat::Identity());
        trunk.limit();
        Vec3 before_m = trunk.pelvis_m();
        Vec3 before_mps = Vec3::Zero();
        Quat turn = Quat::Identity();
        for (int frame = 0; frame < 300; ++frame) {
            if (frame % 20 == 0 && frame < 150) {
                const Vec3 axis = random.direction();
                turn = rotation_about(axis, random.between(0.0, 1.2));
            }
            trunk.put(turn);
            const SpinePose given = trunk.pose.at(k_player);
            const SpinePose& shown = trunk.limit();
            const Vec3 velocity_mps = (trunk.pelvis_m() - before_m) / k_dt_s;
            EXPECT_LT(velocity_mps.norm(), k_chord * k_pelvis_limits.speed_mps) << frame;
            EXPECT_LT((velocity_mps - before_mps).norm(),
                      k_chord * step_mps_of(k_pelvis_limits, 1.0, k_dt_s) + 0.05)
                << frame;
            EXPECT_NEAR(trunk.pelvis_m().norm(), 0.5, k_rounding_m);
            const Pose foot = inverse(shown.pelvis_ws) * shown.legs[0].foot_ws;
            const Pose given_foot = inverse(given.pelvis_ws) * given.legs[0].foot_ws;
            EXPECT_LT((foot.position - given_foot.position).norm(), trunk.scale * k_rounding_m);
            limited += shown.pelvis_ws.position != given.pelvis_ws.position ? 1 : 0;
            before_m = trunk.pelvis_m();
            before_mps = velocity_mps;
        }
        EXPECT_EQ(trunk.pose.at(k_player).pelvis_ws.position,
                  (origin_ws * Pose{trunk.scale * (turn * Vec3(0.0, -0.5, 0.0)), turn}).position);
    }
    EXPECT_GT(limited, 1000);
}

// A trunk that turns over in one frame, about any axis through the chest.
TEST(LimitPelvis, HipsOfAPelvisThatTurnsOverKeepTheirRateAndArrive) {
    Random random(5003);
    int limited = 0;
    for (int i = 0; i < 50; ++i) {
        const Pose origin_ws = random.pose(5.0);
        Trunk trunk(origin_ws, random.between(0.1, 10.0));
        const auto limit_both = [&] {
            trunk.limit();
            limit_feet({.dt_s = k_dt_s,
                        .origin = trunk.origin,
                        .memory = trunk.memory,
                        .pose = trunk.pose});
        };
        const auto hips = [&] {
            const auto& legs = trunk.pose.at(k_player).legs;
            return Vec3(legs[1].thigh_ws.position - legs[0].thigh_ws.position);
        };
        trunk.put(Quat::Identity());
        limit_both();
        const Vec3 axis = random.direction();
        const Quat turn = rotation_about(axis, random.between(0.5, 2.5));
        Vec3 before = hips();
        for (int frame = 0; frame < 270; ++frame) {
            trunk.put(turn);
            const Pose given_pelvis = trunk.pose.at(k_player).pelvis_ws;
            limit_both();
            const double angle_rad = arc_tangent2(before.cross(hips()).norm(), before.dot(hips()));
            EXPECT_LT(angle_rad, k_hips_radps * k_dt_s + k_rounding_m) << frame;
            EXPECT_NEAR(hips().norm(), trunk.scale * 0.18, trunk.scale * k_rounding_m);
            const SpinePose& shown = trunk.pose.at(k_player);
            limited += shown.pelvis_ws.rotation.dot(given_pelvis.rotation) < 0.999 ? 1 : 0;
            before = hips();
        }
        EXPECT_LT(
            (hips() - origin_ws.rotation * (turn * Vec3(trunk.scale * 0.18, 0.0, 0.0))).norm(),
            trunk.scale * k_rounding_m);
    }
    EXPECT_GT(limited, 1000);
}

}  // namespace
}  // namespace handhold::limit_pelvis_test
