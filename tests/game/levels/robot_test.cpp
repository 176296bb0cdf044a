#include "game/levels/robot.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "systems/frame/frame.hpp"

namespace handhold::robot_test {
namespace {

TEST(RobotPath, StaysLevelOverTheHullAndHeadsAlongItsWay) {
    const PosePath path = make_robot_path();
    for (double t_s = 0.0; t_s < path.period_s; t_s += 0.21) {
        const PosePathState state = evaluate(path, t_s);
        EXPECT_NEAR(state.pose.position.y(), k_robot_height_m, 1e-12);
        EXPECT_LT((state.pose.rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
        const Vec3 heading = state.pose.rotation * -Vec3::UnitZ();
        EXPECT_GT(heading.dot(state.velocity_mps.normalized()), 0.99) << t_s;
        EXPECT_NEAR(state.velocity_mps.norm(), 0.45, 0.07) << t_s;
    }
}

TEST(RobotLegs, ReachTheirFootholdsAllTheWayRound) {
    const PosePath path = make_robot_path();
    for (const CrawlerLeg& leg : robot_legs()) {
        for (double t_s = 0.0; t_s < path.period_s; t_s += 0.05) {
            const TwoBones bones = crawler_bones(path, robot_gait(), leg, t_s);
            const Vec3 foot = crawler_foot(path, robot_gait(), leg, t_s);
            ASSERT_LT((bones.end - foot).norm(), 1e-12) << t_s;
            ASSERT_GT(foot.y(), -1e-9);
            ASSERT_GT(bones.middle.y(), 0.5);  // knees stay clear of the hull, y = 0
        }
    }
}

// At least three feet stand, on both sides of the middle.
TEST(RobotLegs, AtLeastThreeStandAtAnyTime) {
    const PosePath path = make_robot_path();
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.013) {
        int left = 0;
        int right = 0;
        for (const CrawlerLeg& leg : robot_legs()) {
            const bool stands = crawler_foot(path, robot_gait(), leg, t_s).y() < 1e-9;
            (leg.hip_bs.x() < 0.0 ? left : right) += stands ? 1 : 0;
        }
        ASSERT_GE(left, 1) << t_s;
        ASSERT_GE(right, 1) << t_s;
        ASSERT_GE(left + right, 3) << t_s;
    }
}

TEST(RobotTorso, IsAboutThreeMetresLongWithRailsOnItsBack) {
    const Structure torso = make_robot_torso();
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (const Mesh& part : torso.parts) {
        for (const Vec3& p : part.positions) {
            low = std::min(low, p.z());
            high = std::max(high, p.z());
        }
    }
    EXPECT_NEAR(high - low, 3.3, 0.4);
    EXPECT_GE(torso.rails.size(), 6U);
    for (const HandrailSpan& rail : torso.rails) {
        EXPECT_GT(rail.start.y(), 0.29) << rail.name;
    }
}

// The robot's bodies are where its path and legs are, for any frame rate.
TEST(RobotScene, BodiesFollowTheClosedFormWhateverTheFrameRate) {
    const auto pose_after = [](int frames, const char* body) {
        Scene scene = *make_built_in_scene("robot");
        FrameCaches caches(scene.shapes(), &scene.grip_meshes());
        StageStats stats;
        for (int frame = 0; frame < frames; ++frame) {
            step_frame(scene.world(), caches, scene.tuning(), {8.0 / frames, {}}, stats);
        }
        const Entity entity = find_by_id(scene.world(), persistent_id_from_name(body));
        return scene.world().body_pose.at(entity).pose_ws;
    };
    for (const char* const body : {"robot", "robot/leg_0_upper", "robot/leg_4_lower"}) {
        const Pose coarse = pose_after(16, body);
        const Pose fine = pose_after(512, body);
        EXPECT_LT((coarse.position - fine.position).norm(), 1e-9) << body;
        EXPECT_LT(rotation_to_vector(coarse.rotation * fine.rotation.conjugate()).norm(), 1e-9)
            << body;
    }
}

}  // namespace
}  // namespace handhold::robot_test
