// Getters of the C interface return the values of definitions, columns and the last step.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/ecs.hpp>
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_getters_test {
namespace {

using namespace test;

TEST(HostGetters, SayWhatDefinitionsSaid) {
    hh_world_def def = hh::world_def();
    def.gravity_mps2 = {0.0, -9.81, 0.0};
    def.reference_velocity_mps = {1.0, 2.0, 3.0};
    hh::World world(def);
    hh::Vec3 gravity{};
    ASSERT_EQ(hh_world_gravity(world.get(), &gravity), HH_OK);
    EXPECT_EQ(gravity.y, -9.81);
    EXPECT_TRUE(world.reference_velocity_mps() == (hh::Vec3{1.0, 2.0, 3.0}));
    hh_body_def body = crate(world, {});
    const hh::Body dynamic = *world.add(body);
    body.kind = HH_KINEMATIC;
    const hh::Body kinematic = *world.add(body);
    EXPECT_EQ(*world.kind(dynamic), HH_DYNAMIC);
    EXPECT_EQ(*world.kind(kinematic), HH_KINEMATIC);
    EXPECT_EQ(*world.mass_kg(dynamic), 2.0);
    EXPECT_EQ(*world.mass_kg(kinematic), 0.0);
    EXPECT_EQ(world.bodies().size(), 2U);
    std::size_t count = 9;
    EXPECT_EQ(hh_body_joints(world.get(), dynamic, nullptr, 0, &count), HH_OK);
    EXPECT_EQ(count, 0U);
    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = dynamic;
    const hh::Joint joint = *world.add(hinge);
    hh::Joint found{};
    ASSERT_EQ(hh_body_joints(world.get(), dynamic, &found, 1, &count), HH_OK);
    EXPECT_TRUE(found == joint);
    EXPECT_EQ(hh_body_joints(world.get(), dynamic, &found, 0, &count), HH_ERROR_CAPACITY);
}

// A static wall moves its player, a loose crate does not, a crate on a hinge does.
TEST(HostHands, SayWhetherTheyMoveTheirPlayer) {
    for (const int what : {0, 1, 2}) {
        HostScene scene;
        if (what == 0) {
            scene.add_wall();
        } else {
            const hh::Body body = *scene.world.add(crate(scene.world, {0.2, 1.4, -0.56}));
            if (what == 2) {
                hh_joint_def hinge = hh::joint_def();
                hinge.kind = HH_HINGE;
                hinge.body_b = body;
                hinge.frame.position = {0.2, 1.4, -0.8};
                ASSERT_TRUE(scene.world.add(hinge));
            }
        }
        scene.step(3);
        EXPECT_FALSE(scene.world.moves_player(scene.player, HH_RIGHT));
        scene.closed[HH_RIGHT] = true;
        scene.step(3);
        ASSERT_NE(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE) << what;
        EXPECT_EQ(scene.world.moves_player(scene.player, HH_RIGHT), what != 1) << what;
    }
}

TEST(HostPlayers, ReferenceVelocityIsThatOfTheLastGrip) {
    HostScene scene;
    const hh::Body lift = scene.add_lift();
    hh::Pose pose = hh::pose_at(k_wall_m);
    EXPECT_TRUE(*scene.world.reference_velocity_mps(scene.player) == hh::Vec3{});
    scene.closed[HH_RIGHT] = true;
    for (int i = 1; i < 20; ++i) {
        pose.position.y += 0.5 * k_step_s;
        ASSERT_TRUE(scene.world.move_kinematic(lift, pose));
        scene.step();
    }
    EXPECT_NEAR(scene.world.reference_velocity_mps(scene.player)->y, 0.5, 1e-9);
}

TEST(HostPlayers, HandInControllerOfTheTuningIsThatOfPlayersWithoutTheirOwn) {
    hh::World world;
    const hh::Player player = *world.add(hh::player_def());
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        EXPECT_TRUE(world.hand_in_controller(side)->rotation ==
                    world.hand_in_controller(player, side)->rotation);
        EXPECT_TRUE(world.hand_in_controller(side)->position ==
                    world.hand_in_controller(player, side)->position);
    }
    ASSERT_TRUE(world.use_wrists(player));
    EXPECT_TRUE(world.hand_in_controller(player, HH_LEFT)->position == hh::Vec3{});
    EXPECT_FALSE(world.hand_in_controller(HH_LEFT)->position == hh::Vec3{});
}

// A player drifts head first into a wall. Without drag and contacts the origin would move by
// velocity times time, so the push-back is the distance from there to the origin after the step.
TEST(HostPlayers, PushBackIsHowFarContactsMovedTheOrigin) {
    HostScene scene;
    ASSERT_TRUE(scene.world.tune("locomotion.drift_drag_per_s", 0.0));
    scene.add_wall();
    scene.step(3);
    EXPECT_EQ(*scene.world.mass_kg(scene.player), 80.0);
    EXPECT_EQ(*scene.world.push_back_m(scene.player), 0.0);
    ASSERT_EQ(hh_player_set_velocity(scene.world.get(), scene.player, {0.0, 0.0, -1.0}), HH_OK);
    double most_m = 0.0;
    for (int i = 0; i < 60; ++i) {
        const hh_player_pose before = *scene.world.pose(scene.player);
        scene.step();
        const hh::Vec3 free = before.origin.position + k_step_s * before.velocity_mps;
        const hh::Vec3 after = scene.world.pose(scene.player)->origin.position;
        const double pushed_m = *scene.world.push_back_m(scene.player);
        EXPECT_NEAR(pushed_m, hh::length(after - free), 1e-9) << i;
        most_m = std::max(most_m, pushed_m);
    }
    EXPECT_GT(most_m, 1e-3);
}

TEST(HostThreads, MayChangeWhileAWorldExists) {
    const hh::World world;
    const std::uint32_t before = hh_thread_count();
    ASSERT_EQ(hh_set_thread_count(3), HH_OK);
    EXPECT_EQ(hh_thread_count(), 3U);
    EXPECT_EQ(hh_set_thread_count(0), HH_ERROR_VALUE);
    EXPECT_EQ(hh_set_thread_count(257), HH_ERROR_VALUE);
    EXPECT_EQ(hh_thread_count(), 3U);
    ASSERT_EQ(hh_set_thread_count(before), HH_OK);
}

TEST(HostTuning, NumbersAreKeptAndRestoredAtOnce) {
    hh::World world;
    const std::vector<double> before = world.tuning_numbers();
    std::size_t described = 0;
    hh_tuning_info info = hh_default_tuning_info();
    for (std::size_t i = 0; hh_tuning_describe(i, &info) == HH_OK; ++i) {
        double values[3] = {};
        ASSERT_EQ(hh_world_get_tuning(world.get(), info.name, values, info.count), HH_OK);
        for (std::size_t j = 0; j < info.count; ++j) {
            ASSERT_LT(described, before.size());
            EXPECT_EQ(before[described++], values[j]) << info.name;
        }
    }
    EXPECT_EQ(described, before.size());
    ASSERT_TRUE(world.tune("hand.reach_m", 0.123));
    EXPECT_NE(world.tuning_numbers(), before);
    ASSERT_TRUE(world.set_tuning_numbers(before));
    EXPECT_EQ(world.tuning_numbers(), before);
    std::vector<double> wrong = before;
    wrong.back() = std::nan("");
    wrong.front() += 1e-6;
    EXPECT_EQ(world.set_tuning_numbers(wrong).result(), HH_ERROR_VALUE);
    EXPECT_EQ(world.set_tuning_numbers(std::span(before).first(5)).result(), HH_ERROR_VALUE);
    wrong = before;
    wrong.push_back(0.0);
    EXPECT_EQ(world.set_tuning_numbers(wrong).result(), HH_ERROR_VALUE);
    EXPECT_EQ(world.tuning_numbers(), before);
}

TEST(HostStats, CountHandsAndMomentum) {
    HostScene scene;
    scene.add_wall();
    scene.step(3);
    scene.closed[HH_RIGHT] = true;
    scene.step();
    const hh_world_stats stats = *scene.world.stats();
    EXPECT_EQ(stats.hands_closed, 1U);
    EXPECT_EQ(stats.hands_gripped, 1U);
    scene.hand_at[HH_RIGHT].z += 0.02;  // pulls the player, 80 kg, towards the wall
    scene.step();
    const hh_momentum momentum = scene.world.stats()->momentum;
    hh::Vec3 sum{};
    for (const hh::Vec3& one : momentum.linear_kgmps) {
        sum += one;
    }
    EXPECT_NEAR(hh::length(sum), 0.0, 1e-9);
    EXPECT_NEAR(momentum.linear_kgmps[HH_MOMENTUM_PLAYERS].z, -80.0 * 0.02 * 90.0, 1.0);
    EXPECT_EQ(scene.world.fallbacks().size(), static_cast<std::size_t>(Fallback::count));
    EXPECT_EQ(scene.world.stage_times_us().size(), static_cast<std::size_t>(Stage::count));
}

}  // namespace
}  // namespace handhold::host_getters_test
