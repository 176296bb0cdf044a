// What a host's calls do to bodies and players, by the C interface's C++ wrapper.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_rules_test {
namespace {

using namespace test;

TEST(HostGravity, DynamicBodiesFallAsTheClosedFormSays) {
    hh::World world;
    ASSERT_EQ(hh_world_set_gravity(world.get(), {0.0, -9.81, 0.0}), HH_OK);
    hh_body_def def = crate(world, {0.0, 100.0, 0.0});
    const hh::Body falls = *world.add(def);
    def.pose.position.x = 3.0;
    def.gravity_scale = 0.25;
    const hh::Body sinks = *world.add(def);
    constexpr int k_steps = 60;
    for (int i = 0; i < k_steps; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
    }
    // Velocity first, then position: the sum over i of g dt^2 i.
    const double fallen_m = 9.81 * k_step_s * k_step_s * k_steps * (k_steps + 1) / 2.0;
    EXPECT_NEAR(world.pose(falls)->position.y, 100.0 - fallen_m, 1e-9);
    EXPECT_NEAR(world.pose(sinks)->position.y, 100.0 - 0.25 * fallen_m, 1e-9);
}

TEST(HostGravity, CrateRestsOnTheFloor) {
    hh::World world;
    ASSERT_EQ(hh_world_set_gravity(world.get(), {0.0, -9.81, 0.0}), HH_OK);
    hh_body_def floor = hh::body_def();
    floor.shape = *world.add_box({5.0, 0.5, 5.0});
    ASSERT_TRUE(world.add(floor));
    const hh::Body body = *world.add(crate(world, {0.0, 0.8, 0.0}));
    for (int i = 0; i < 180; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
    }
    EXPECT_NEAR(world.pose(body)->position.y, 0.6, 1e-3);
}

RC_GTEST_PROP(HostLayers, BodiesTouchOnlyIfBothMasksSaySo, ()) {
    const auto layers = *rc::gen::container<std::vector<std::uint32_t>>(
        4, rc::gen::element<std::uint32_t>(1, 2, 3, 4));
    hh::World world;
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({1.0, 1.0, 0.1});
    wall.layers = layers[0];
    wall.mask = layers[1];
    RC_ASSERT(static_cast<bool>(world.add(wall)));
    hh_body_def thrown = crate(world, {0.0, 0.0, 0.5});
    thrown.velocity_mps = {0.0, 0.0, -1.0};
    thrown.layers = layers[2];
    thrown.mask = layers[3];
    const hh::Body body = *world.add(thrown);
    for (int i = 0; i < 120; ++i) {
        RC_ASSERT(static_cast<bool>(world.step(k_step_s)));
    }
    const bool touch = (layers[0] & layers[3]) != 0 && (layers[2] & layers[1]) != 0;
    RC_ASSERT((world.pose(body)->position.z > 0.0) == touch);
}

TEST(HostKinematic, BodyReachesItsTargetAndCarriesTheHand) {
    HostScene scene;
    const hh::Body body = scene.add_lift();
    scene.closed[HH_RIGHT] = true;
    scene.step();
    ASSERT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_SURFACE);
    hh::Pose pose = hh::pose_at(k_wall_m);
    for (int i = 1; i <= 50; ++i) {
        pose.position.x = 0.01 * i;
        pose.position.y = 1.5 + 0.1 * std::sin(0.1 * i);
        ASSERT_TRUE(scene.world.move_kinematic(body, pose));
        scene.step();
        EXPECT_EQ(scene.world.pose(body)->position.y, pose.position.y);
        EXPECT_LT(scene.hand(HH_RIGHT).error_m, 1e-6);
    }
    EXPECT_NEAR(scene.world.pose(scene.player)->origin.position.x, 0.5, 1e-6);
    hh::Vec3 velocity{};
    ASSERT_EQ(hh_body_velocity(scene.world.get(), body, &velocity, nullptr), HH_OK);
    EXPECT_NEAR(velocity.x, 0.01 / k_step_s, 1e-9);
    scene.step();  // no new target: it rests
    ASSERT_EQ(hh_body_velocity(scene.world.get(), body, &velocity, nullptr), HH_OK);
    EXPECT_EQ(velocity.x, 0.0);
}

TEST(HostTeleport, PlayerPassesWallsAndTakesAlongWhatIsHeld) {
    HostScene scene;
    hh_body_def wall = hh::body_def();
    wall.shape = *scene.world.add_box({5.0, 5.0, 0.1});
    wall.pose.position = {0.0, 1.5, 3.0};
    ASSERT_TRUE(scene.world.add(wall));
    const hh::Body held = *scene.world.add(crate(scene.world, {0.2, 1.4, -0.6}));
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    ASSERT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_HELD);
    ASSERT_TRUE(scene.world.teleport(scene.player, hh::pose_at({0.0, 0.0, 6.0})));
    scene.step(3);
    const hh_player_pose pose = *scene.world.pose(scene.player);
    EXPECT_NEAR(pose.origin.position.z, 6.0, 1e-6) << "the head was not swept into the wall";
    EXPECT_NEAR(scene.world.pose(held)->position.z, 6.0 - 0.6, 1e-6);
    EXPECT_TRUE(scene.hand(HH_RIGHT).body == held);
}

TEST(HostTeleport, HandsLetGoOfABodyThatJumps) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    scene.closed[HH_RIGHT] = true;
    scene.step();
    ASSERT_TRUE(scene.hand(HH_RIGHT).body == wall);
    ASSERT_TRUE(scene.world.teleport(wall, hh::pose_at({0.0, 1.5, -9.0})));
    scene.step();
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    EXPECT_EQ(scene.log, "grab right;release right by_host;");
    EXPECT_NEAR(scene.world.pose(scene.player)->origin.position.z, 0.0, 1e-9);
}

RC_GTEST_PROP(HostGrabRules, PriorityCountsOnlyInSightOfThePalm, (bool is_behind)) {
    const double x_m = *rc::gen::inRange(140, 260) * 1e-3;
    const double y_m = *rc::gen::inRange(1340, 1460) * 1e-3;
    HostScene scene;
    RC_ASSERT(static_cast<bool>(scene.world.tune("hand.reach_m", 0.3)));
    hh_body_def panel = hh::body_def();
    panel.shape = *scene.world.add_box({2.0, 2.0, 0.005});
    panel.pose.position = {0.0, 1.5, -0.5};
    const hh::Body wall = *scene.world.add(panel);
    hh_body_def knob = hh::body_def();
    knob.shape = *scene.world.add_box({0.01, 0.01, 0.01});
    knob.pose.position = {x_m, y_m, is_behind ? -0.52 : -0.48};
    const hh::Body preferred = *scene.world.add(knob);
    RC_ASSERT(hh_body_set_grab_rule(scene.world.get(), preferred, true, true, false, 5) == HH_OK);
    scene.step(2);
    scene.closed[HH_RIGHT] = true;
    scene.step();
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
    RC_ASSERT(scene.hand(HH_RIGHT).body == (is_behind ? wall : preferred));
}

TEST(HostOrders, OrderForAHandThatOpensMovesNothing) {
    HostScene scene;
    const hh::Body body = *scene.world.add(crate(scene.world, {0.8, 1.4, -0.9}));
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    ASSERT_TRUE(scene.world.grip(scene.player, HH_RIGHT, body));
    scene.closed[HH_RIGHT] = false;
    scene.step(2);
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    EXPECT_EQ(scene.world.pose(body)->position.x, 0.8);
    EXPECT_EQ(scene.world.pose(scene.player)->origin.position.x, 0.0);
}

TEST(HostGrabRules, HandsThatMayNotGripAreRefused) {
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        HostScene scene;
        const hh::Body wall = scene.add_wall();
        ASSERT_EQ(hh_body_set_grab_rule(scene.world.get(), wall, side == HH_LEFT, side == HH_RIGHT,
                                        false, 0),
                  HH_OK);
        scene.closed = {true, true};
        scene.step();
        const hh::Side other = side == HH_LEFT ? HH_RIGHT : HH_LEFT;
        EXPECT_EQ(scene.hand(side).grip, HH_GRIP_SURFACE);
        EXPECT_EQ(scene.hand(other).grip, HH_GRIP_NONE);
        EXPECT_NE(scene.log.find(other == HH_LEFT ? "refuse left not_allowed"
                                                  : "refuse right not_allowed"),
                  std::string::npos)
            << scene.log;
    }
}

TEST(HostGrabRules, PlayersGripOnlyTheirLayers) {
    HostScene scene(2U);
    hh_body_def wall = hh::body_def();
    wall.shape = *scene.world.add_box({2.0, 2.0, 0.05});
    wall.pose.position = {0.0, 1.5, -0.55};
    ASSERT_TRUE(scene.world.add(wall));  // layer 1, before
    wall.pose.position.z = -0.58;
    wall.layers = 2;
    const hh::Body behind = *scene.world.add(wall);
    scene.closed[HH_RIGHT] = true;
    scene.step();
    EXPECT_TRUE(scene.hand(HH_RIGHT).body == behind);
}

TEST(HostGrabRules, HigherPriorityIsTakenFirst) {
    HostScene scene;
    scene.add_wall();
    hh_body_def handle = hh::body_def();
    handle.shape = *scene.world.add_box({0.02, 0.02, 0.02});
    handle.pose.position = {0.2, 1.42, -0.47};
    handle.grab_priority = 5;
    const hh::Body wanted = *scene.world.add(handle);
    scene.closed[HH_RIGHT] = true;
    scene.step();
    EXPECT_TRUE(scene.hand(HH_RIGHT).body == wanted);
}

TEST(HostGrabRules, BodyForTwoHandsIsGrippedByBothOrNone) {
    HostScene scene;
    hh_body_def bar = crate(scene.world, {0.0, 1.4, -0.6});
    bar.shape = *scene.world.add_box({0.5, 0.1, 0.1});
    bar.grab_two_hands = true;
    const hh::Body body = *scene.world.add(bar);
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    EXPECT_EQ(scene.log, "refuse right needs_two;");
    scene.closed[HH_LEFT] = true;
    scene.step(3);
    EXPECT_TRUE(scene.hand(HH_RIGHT).body == body);
    EXPECT_TRUE(scene.hand(HH_LEFT).body == body);
    scene.closed[HH_LEFT] = false;
    scene.step(2);
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    EXPECT_EQ(scene.hand(HH_LEFT).grip, HH_GRIP_NONE);
}

TEST(HostOrders, HandGripsAndReleasesWhenToldTo) {
    HostScene scene;
    const hh::Body body = *scene.world.add(crate(scene.world, {0.9, 1.4, -0.6}));
    scene.step();
    ASSERT_TRUE(scene.world.grip(scene.player, HH_RIGHT, body));
    scene.step(5);
    EXPECT_TRUE(scene.hand(HH_RIGHT).body == body);
    EXPECT_NEAR(scene.world.pose(body)->position.x, 0.9, 1e-9) << "gripped where it is";
    scene.hand_at[HH_RIGHT].z += 0.1;
    scene.step();
    EXPECT_NEAR(scene.world.pose(body)->position.z, -0.5, 1e-6) << "it moves with the hand";
    ASSERT_TRUE(scene.world.release(scene.player, HH_RIGHT));
    scene.step();
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    EXPECT_EQ(scene.log, "grab right;release right by_host;");
}

// Nothing was stepped in between: the search must not see what the last step saw.
TEST(HostFindGrip, SeesWhatCameAndWentSinceTheLastStep) {
    HostScene scene;
    hh_body_def def = hh::body_def();
    def.shape = *scene.world.add_box({2.0, 2.0, 0.1});
    def.pose.position = {0.0, 1.5, -0.6};
    const hh::Body near = *scene.world.add(def);
    scene.step(3);
    const auto find = [&] {
        hh_surface_hit hit{};
        EXPECT_EQ(hh_hand_find_grip(scene.world.get(), scene.player, HH_RIGHT, &hit), HH_OK);
        return hit;
    };
    EXPECT_EQ(find().body, near);
    ASSERT_EQ(hh_body_remove(scene.world.get(), near), HH_OK);
    ASSERT_EQ(hh_shape_remove(scene.world.get(), def.shape), HH_OK);
    EXPECT_EQ(find().body.generation, 0U);
    def.shape = *scene.world.add_box({1.0, 1.0, 0.1});
    const hh::Body again = *scene.world.add(def);
    EXPECT_EQ(find().body, again);
    def.pose.position.z = -5.0;
    ASSERT_EQ(hh_body_teleport(scene.world.get(), again, def.pose), HH_OK);
    EXPECT_EQ(find().body.generation, 0U);
}

}  // namespace
}  // namespace handhold::host_rules_test
