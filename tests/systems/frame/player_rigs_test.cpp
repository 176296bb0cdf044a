// Two players of one world with hands of different sizes.
#include <array>
#include <cstddef>

#include <gtest/gtest.h>

#include "systems/frame/frame.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"

namespace handhold::player_rigs_test {
namespace {

constexpr double k_step_s = 1.0 / 90.0;

TEST(PlayerRigs, TwoPlayersHaveDifferentHands) {
    ShapeLibrary shapes;
    World world;
    std::array<PlayerEntities, 2> players;
    players[0] =
        add_player(world, {.name = "small", .body = {}, .origin_ws = {}, .head_shape = k_no_shape});
    players[1] =
        add_player(world, {.name = "tall", .body = {}, .origin_ws = {}, .head_shape = k_no_shape});
    BodyDescription wall;
    wall.name = "wall";
    wall.pose_ws.position = Vec3(0.0, 1.5, -0.6);
    wall.shape = shapes.add_box(Vec3(2.0, 2.0, 0.1));
    add_body(world, wall);
    const GripMeshLibrary meshes(shapes);
    FrameCaches caches(shapes, &meshes);
    HandRig large = builtin_hand_rig(HandSide::right);
    for (FingerRig& finger : large.fingers) {
        finger.base_hs.position *= 1.5;
        for (std::size_t link = 0; link < k_max_links; ++link) {
            finger.length_m[link] *= 1.5;
        }
    }
    caches.more_hand_rigs.push_back(large);
    world.hand_rig.add(players[1].hands[1], {0});
    StageStats stats;
    for (int frame = 1; frame <= 60; ++frame) {
        TrackingSample sample;
        sample.t_s = world.clock.t_s + k_step_s;
        sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const auto which = static_cast<HandSide>(side);
            const Pose wrist{Vec3(side == 1 ? 0.2 : -0.2, 1.4, -0.43),
                             rotation_about(Vec3::UnitX(), k_half_pi)};
            sample.controllers[side].controller_ps =
                wrist * inverse(default_controller_to_hand(which, HandTuning{}));
            sample.controllers[side].grab = frame > 5;
        }
        const std::array inputs = {PlayerInput{players[0].player, {&sample, 1}, {}},
                                   PlayerInput{players[1].player, {&sample, 1}, {}}};
        step_frame(world, caches, {}, {k_step_s, inputs}, stats);
    }
    EXPECT_EQ(caches.hands.surroundings.size(), 4U);
    const auto rig_of = [&](Entity hand) {
        for (const HandSurroundings& around : caches.hands.surroundings) {
            if (around.hand == hand) {
                return around.rig;
            }
        }
        return static_cast<const HandRig*>(nullptr);
    };
    EXPECT_EQ(rig_of(players[1].hands[1]), caches.more_hand_rigs.data());
    EXPECT_EQ(rig_of(players[0].hands[1]), &caches.hand_rigs[1]);
    const auto& small = world.finger_pose.at(players[0].hands[1]).shown;
    const auto& tall = world.finger_pose.at(players[1].hands[1]).shown;
    EXPECT_NE(small[1].curl_rad, tall[1].curl_rad) << "equal angles for different fingers";
}

}  // namespace
}  // namespace handhold::player_rigs_test
