// Names, surface queries, events, pausing and saving of the C interface.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_interface_test {
namespace {

using namespace test;

TEST(HostNames, AreKeptAndFound) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    const char* name = nullptr;
    ASSERT_EQ(hh_body_name(scene.world.get(), wall, &name), HH_OK);
    EXPECT_STREQ(name, "wall");
    EXPECT_TRUE(*scene.world.find_body("wall") == wall);
    EXPECT_EQ(scene.world.find_body("window").status().result(), HH_ERROR_NAME);
    hh_body_def twin = hh::body_def();
    twin.name = "wall";
    EXPECT_EQ(scene.world.add(twin).status().result(), HH_ERROR_NAME);
    std::vector<std::byte> saved;
    ASSERT_TRUE(scene.world.save(saved));
    ASSERT_TRUE(scene.world.remove(wall));
    EXPECT_FALSE(scene.world.find_body("wall"));
    ASSERT_TRUE(scene.world.restore(saved));
    ASSERT_EQ(hh_body_name(scene.world.get(), wall, &name), HH_OK);
    EXPECT_STREQ(name, "wall");
}

TEST(HostWrapper, IteratesOverATemporary) {
    HostScene scene;
    scene.step();
    std::size_t valid = 0;
    for (const hh_hand_joint& joint :
         *scene.world.hand_joints(scene.player, HH_RIGHT, HH_SPACE_WORLD)) {
        valid += joint.is_valid ? 1 : 0;
    }
    EXPECT_GT(valid, 20U);
    const auto& hand = *scene.world.hand(scene.player, HH_RIGHT);
    EXPECT_TRUE(hand.is_tracked);
}

// A query that calls back into its world.
struct CallingBack {
    hh_world* world = nullptr;
    hh_result step = HH_OK;
    hh_result add = HH_OK;
    hh_result read = HH_ERROR_INTERNAL;
    int calls = 0;
};
std::uint8_t call_back(void* context, hh_vec3, hh_vec3, const hh_body*, size_t, hh_surface_hit*) {
    auto& self = *static_cast<CallingBack*>(context);
    const hh_body_def def = hh_default_body_def();
    hh_body body{};
    hh_world_stats stats = hh_default_world_stats();
    self.step = hh_world_step(self.world, k_step_s, nullptr, 0);
    self.add = hh_body_add(self.world, &def, &body);
    self.read = hh_world_get_stats(self.world, &stats);
    ++self.calls;
    return false;
}

TEST(HostSurfaces, AQueryMayReadItsWorldButNotChangeIt) {
    HostScene scene;
    CallingBack called{scene.world.get()};
    hh_surface_query query = hh_default_surface_query();
    query.context = &called;
    query.cast_ray = call_back;
    ASSERT_EQ(hh_world_set_surface_query(scene.world.get(), &query), HH_OK);
    scene.closed[HH_RIGHT] = true;
    scene.step(2);
    ASSERT_GT(called.calls, 0);
    EXPECT_EQ(called.step, HH_ERROR_STATE);
    EXPECT_EQ(called.add, HH_ERROR_STATE);
    EXPECT_EQ(called.read, HH_OK);
    EXPECT_NEAR(scene.world.time_s(), 2 * k_step_s, 1e-12);
}

std::uint8_t throw_once(void* context, hh_vec3, hh_vec3, const hh_body*, size_t, hh_surface_hit*) {
    int& calls = *static_cast<int*>(context);
    if (calls++ == 0) {
        throw std::runtime_error("the host's ray failed");
    }
    return false;
}

TEST(HostSurfaces, AQueryThatThrowsFailsOneStep) {
    HostScene scene;
    scene.step();
    int calls = 0;
    hh_surface_query query = hh_default_surface_query();
    query.context = &calls;
    query.cast_ray = throw_once;
    ASSERT_EQ(hh_world_set_surface_query(scene.world.get(), &query), HH_OK);
    hh::Sample sample = scene.sample();
    sample.grab[HH_RIGHT] = true;
    const auto step = [&] {
        sample.time_s = scene.world.time_s() + k_step_s;
        return scene.world.step(k_step_s, hh::input(scene.player, {&sample, 1})).result();
    };
    EXPECT_EQ(step(), HH_ERROR_INTERNAL);
    EXPECT_EQ(step(), HH_OK);
    EXPECT_GT(calls, 0);
}

TEST(HostEvents, SayWhyAGripEnded) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    scene.step();
    scene.closed[HH_RIGHT] = true;
    scene.step();
    scene.closed[HH_RIGHT] = false;
    scene.step();
    EXPECT_EQ(scene.log, "grab right;release right;");
    scene.closed[HH_RIGHT] = true;
    scene.step();
    ASSERT_TRUE(scene.world.remove(wall));
    scene.step();
    EXPECT_EQ(scene.log, "grab right;release right;grab right;slip right body_gone;");
}

TEST(HostEvents, LatchesAndLimitsAreReportedOnce) {
    hh::World world;
    hh_body_def panel = crate(world, {0.4, 0.0, 0.0});
    panel.angular_velocity_radps = {0.0, 0.0, 1.0};
    panel.velocity_mps = {0.0, 0.4, 0.0};
    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = *world.add(panel);
    hinge.frame.rotation = {0.0, -std::sqrt(0.5), 0.0, std::sqrt(0.5)};  // x becomes z
    hinge.limited = true;
    hinge.lower = -1.0;
    hinge.upper = 0.5;
    const hh::Joint joint = *world.add(hinge);
    int reached = 0;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
        for (const hh::Event& event : world.events()) {
            reached += event.kind == HH_EVENT_LIMIT_REACHED && event.joint == joint ? 1 : 0;
        }
    }
    double angle_rad = 0.0;
    ASSERT_EQ(hh_joint_state(world.get(), joint, &angle_rad, nullptr, nullptr), HH_OK);
    EXPECT_GE(reached, 1);
    EXPECT_LE(reached, 2) << "not in every step that it rests there";
    EXPECT_LT(std::fabs(angle_rad), 1.0 + 1e-6);
}

TEST(HostPause, ShowsHandsWhileTheWorldStandsStill) {
    HostScene scene;
    scene.add_wall();
    const hh::Body thrown = *scene.world.add(crate(scene.world, {3.0, 1.0, 0.0}));
    ASSERT_TRUE(scene.world.set_velocity(thrown, {0.5, 0.0, 0.0}));
    scene.step();
    scene.closed[HH_RIGHT] = true;
    scene.step(3);
    const double x_m = scene.world.pose(thrown)->position.x;
    const double time_s = scene.world.time_s();
    const hh_player_pose before = *scene.world.pose(scene.player);
    scene.hand_at[HH_LEFT].y += 0.3;
    scene.hand_at[HH_RIGHT].z += 0.1;  // less than hand.max_stretch_m
    const hh::Sample now = scene.sample();
    const std::array inputs = {hh::input(scene.player, {&now, 1})};
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(scene.world.step_pose_only(k_step_s, inputs));
    }
    const hh_player_pose paused = *scene.world.pose(scene.player);
    EXPECT_EQ(scene.world.pose(thrown)->position.x, x_m);
    EXPECT_EQ(scene.world.time_s(), time_s);
    EXPECT_EQ(paused.origin.position.z, before.origin.position.z);
    EXPECT_NEAR(paused.hands[HH_LEFT].tracked.position.y,
                before.hands[HH_LEFT].tracked.position.y + 0.3, 1e-12);
    // The hand that stayed closed grips where it is now: the player is not pulled.
    scene.step(3);
    const hh_player_pose after = *scene.world.pose(scene.player);
    EXPECT_EQ(after.hands[HH_RIGHT].grip, HH_GRIP_SURFACE);
    EXPECT_NEAR(after.origin.position.z, before.origin.position.z, 1e-6);
    EXPECT_GT(scene.world.pose(thrown)->position.x, x_m);
}

// Frames in which the right hand grips the wall and pulls. The samples are of `late_s` after the
// steps' ends.
void play(HostScene& scene, int from, int to, double late_s) {
    for (int i = from; i < to; ++i) {
        hh::Sample now = scene.sample();
        now.time_s += late_s;
        now.grab[HH_RIGHT] = i > 10;
        now.hands[HH_RIGHT].position.z += 0.004 * i;
        RC_ASSERT(
            static_cast<bool>(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1}))));
    }
}

RC_GTEST_PROP(HostSnapshots, ReplayAfterRestoreIsBitForBitEqual, ()) {
    const int saved_at = *rc::gen::inRange(1, 30);
    const double late_s = *rc::gen::element(0.0, 0.004, 0.02);
    HostScene scene;
    scene.add_wall();
    play(scene, 0, saved_at, late_s);
    std::vector<std::byte> saved;
    RC_ASSERT(static_cast<bool>(scene.world.save(saved)));
    play(scene, saved_at, 40, late_s);
    const std::uint64_t hash = scene.world.hash();
    RC_ASSERT(static_cast<bool>(scene.world.add(crate(scene.world, {0.0, 9.0, 0.0}))));
    RC_ASSERT(hash != scene.world.hash());
    // Shapes are named by content, so the crate's may stay. The crate goes.
    RC_ASSERT(static_cast<bool>(scene.world.restore(saved)));
    std::size_t count = 0;
    RC_ASSERT(hh_world_bodies(scene.world.get(), nullptr, 0, &count) == HH_OK && count == 1);
    play(scene, saved_at, 40, late_s);
    RC_ASSERT(hash == scene.world.hash());
}

}  // namespace
}  // namespace handhold::host_interface_test
