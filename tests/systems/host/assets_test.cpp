// Rigs, authored grips, shapes and body clips that a host gives to the C interface.
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_assets_test {
namespace {

using namespace test;

// Bytes in memory have no file name, and no file is read beside them.
TEST(HostRigs, RefusalsNameTheRigAndWhatIsWrong) {
    HostScene scene;
    const std::string outside =
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"rig.bin"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":4}],"nodes":[{}]})";
    EXPECT_EQ(
        hh_player_set_body_rig(scene.world.get(), scene.player, outside.data(), outside.size()),
        HH_ERROR_DATA);
    EXPECT_EQ(std::string_view(hh_last_error()).substr(0, 10), "body rig: ") << hh_last_error();
    EXPECT_EQ(hh_player_set_hand_rig(scene.world.get(), scene.player, HH_LEFT, "{}", 2),
              HH_ERROR_DATA);
    EXPECT_EQ(std::string_view(hh_last_error()).substr(0, 10), "hand rig: ") << hh_last_error();
}

TEST(HostGrips, IndexFingerOfAnAuthoredGripFollowsTheTrigger) {
    HostScene scene;
    hh_body_def def = crate(scene.world, {0.2, 1.4, -0.53});
    const hh::Body held = *scene.world.add(def);
    hh_grip_def grip = hh::grip_def();
    hh_grip_hand& hand = grip.hands[HH_RIGHT];
    hand.is_used = true;
    hand.wrist = hh::pose_at({0.0, 0.0, 0.14}, {0.7071067811865476, 0.0, 0.0, 0.7071067811865476});
    for (hh_finger& finger : hand.fingers) {
        finger.is_posed = true;
    }
    hand.fingers[1].follows_trigger = true;
    hand.fingers[1].pressed_curl_rad[0] = 0.8;
    ASSERT_TRUE(scene.world.add_grip(held, grip));
    const auto tip_after = [&](double trigger) {
        for (int i = 0; i < 60; ++i) {
            hh::Sample now = scene.sample();
            now.time_s += 0.003;
            now.trigger[HH_RIGHT] = trigger;
            EXPECT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1})));
        }
        EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_AUTHORED);
        const auto joints = *scene.world.hand_joints(scene.player, HH_RIGHT, HH_SPACE_WORLD);
        return joints[HH_INDEX_TIP].pose.position;
    };
    scene.step();
    scene.closed[HH_RIGHT] = true;
    const hh::Vec3 released = tip_after(0.0);
    const hh::Vec3 half = tip_after(0.5);
    const hh::Vec3 pressed = tip_after(1.0);
    EXPECT_GT(distance_m(released, half), 0.02);
    EXPECT_GT(distance_m(half, pressed), 0.02);
    EXPECT_LT(distance_m(tip_after(0.0), released), 1e-6);
}

TEST(HostShapes, BadMeshesNameTheVertexOrTriangle) {
    const auto error_of = [](const std::vector<float>& xyz, const std::vector<std::uint32_t>& of) {
        const hh::Mesh mesh(xyz, of);
        EXPECT_FALSE(mesh.is_valid());
        return std::string(hh_last_error());
    };
    std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT_NE(error_of(xyz, {0, 1, 2, 0, 4, 1}).find("triangle 1 "), std::string::npos);
    xyz[7] = std::nanf("");
    EXPECT_NE(error_of(xyz, {0, 1, 2}).find("vertex 2 "), std::string::npos);
}

TEST(HostShapes, HullsKeepTheFrameInWhichTheHostMadeThem) {
    hh::World world;
    // A box of 0.2 x 0.4 x 0.6 m whose corner is the host's origin.
    std::vector<hh::Vec3> corners;
    for (const double x : {0.0, 0.2}) {
        for (const double y : {0.0, 0.4}) {
            for (const double z : {0.0, 0.6}) {
                corners.push_back({x, y, z});
            }
        }
    }
    hh_body_def def = hh::body_def();
    def.kind = HH_DYNAMIC;
    def.shape = *world.add_hull(corners);
    def.pose = hh::pose_at({1.0, 2.0, 3.0});
    const hh::Body body = *world.add(def);
    EXPECT_LT(distance_m(world.pose(body)->position, {1.0, 2.0, 3.0}), 1e-9);
    EXPECT_NEAR(std::fabs(world.pose(body)->rotation.w), 1.0, 1e-9);
    ASSERT_TRUE(world.set_velocity(body, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
    for (int i = 0; i < 90; ++i) {
        ASSERT_TRUE(world.step(k_step_s));
    }
    // It turns about its centre of mass, (1.1, 2.2, 3.3): the corner's distance from it stays.
    const double arm_m = distance_m(world.pose(body)->position, {1.1, 2.2, 3.3});
    EXPECT_NEAR(arm_m, std::hypot(0.1, 0.2, 0.3), 1e-6);
    EXPECT_GT(distance_m(world.pose(body)->position, {1.0, 2.0, 3.0}), 0.1);
    ASSERT_TRUE(world.teleport(body, hh::pose_at({-1.0, 0.0, 0.0})));
    EXPECT_LT(distance_m(world.pose(body)->position, {-1.0, 0.0, 0.0}), 1e-9);
}

TEST(HostBodyClips, MoveLegsAndNeverHandsAndBadOnesChangeNothing) {
    HostScene plain;
    HostScene clipped;
    HostScene refused;
    constexpr std::string_view k_idle =
        R"({"idle": {"keys": [{"at": 0}, {"at": 1, "left_thigh": [30, 0, 0]}, {"at": 2}]}})";
    ASSERT_TRUE(clipped.world.load_body_clips(k_idle));
    EXPECT_EQ(refused.world.load_body_clips(R"({"idle": {"keys": 3}})").result(), HH_ERROR_DATA);
    EXPECT_NE(std::string(hh_last_error()).find("/idle/keys"), std::string::npos);
    const auto joints = [](const HostScene& scene) {
        return *scene.world.body_joints(scene.player, HH_SPACE_WORLD);
    };
    const auto apart_m = [&](const HostScene& a, const HostScene& b, hh_body_joint joint) {
        return distance_m(joints(a)[joint].position, joints(b)[joint].position);
    };
    for (HostScene* const scene : {&plain, &clipped, &refused}) {
        scene->add_wall();
        scene->step(90);
    }
    EXPECT_GT(apart_m(plain, clipped, HH_LEFT_FOOT), 0.1);
    EXPECT_EQ(apart_m(plain, clipped, HH_RIGHT_HAND), 0.0);
    EXPECT_EQ(refused.world.hash(), plain.world.hash());
    ASSERT_TRUE(clipped.world.load_body_clips({}));
    for (HostScene* const scene : {&plain, &clipped}) {
        scene->step(90);  // feet return at a bounded speed
    }
    EXPECT_LT(apart_m(plain, clipped, HH_LEFT_FOOT), 1e-9);
}

}  // namespace
}  // namespace handhold::host_assets_test
