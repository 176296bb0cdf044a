// Players of a match, drawn displaced.
#include "game/view/shown_offset.hpp"

#include <gtest/gtest.h>

namespace handhold::shown_offset_test {
namespace {

// Arms that hang straight down from shoulders at 1.4 m, with bones of 0.3 m.
RenderPose standing() {
    RenderPose pose;
    pose.head_ws.position = {0.0, 1.6, 0.0};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double x = side == 0 ? -0.2 : 0.2;
        const Quat down = rotation_between(-Vec3::UnitZ(), -Vec3::UnitY());
        ArmPose::Arm& arm = pose.arms.arms[side];
        arm.upper_ws = {Vec3(x, 1.4, 0.0), down};
        arm.forearm_ws = {Vec3(x, 1.1, 0.0), down};
        arm.hand_ws = {Vec3(x, 0.8, 0.0), down};
        pose.hands[side].shown_ws = arm.hand_ws;
    }
    return pose;
}

Vec3 bone_end(const Pose& bone_ws, double length_m) {
    return bone_ws.position + length_m * (bone_ws.rotation * -Vec3::UnitZ());
}

TEST(ShownOffset, NoneChangesNothing) {
    const RenderPose pose = standing();
    const RenderPose drawn = displaced(pose, {});
    EXPECT_EQ(drawn.head_ws.position, pose.head_ws.position);
    EXPECT_LT((drawn.arms.arms[1].forearm_ws.rotation.coeffs() -
               pose.arms.arms[1].forearm_ws.rotation.coeffs())
                  .norm(),
              1e-12);
}

TEST(ShownOffset, ArmsStillLeadFromTheBodyToTheHands) {
    const ShownOffset by{Vec3(0.05, 0.0, 0.0), {Vec3(0.0, 0.02, 0.03), Vec3(-0.1, 0.05, 0.2)}};
    const RenderPose pose = standing();
    const RenderPose drawn = displaced(pose, by);
    EXPECT_EQ(drawn.head_ws.position, Vec3(pose.head_ws.position + by.head));
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ArmPose::Arm& arm = drawn.arms.arms[side];
        EXPECT_EQ(arm.hand_ws.position,
                  Vec3(pose.arms.arms[side].hand_ws.position + by.hands[side]));
        EXPECT_EQ(drawn.hands[side].shown_ws.position, arm.hand_ws.position);
        const double upper_m = (arm.forearm_ws.position - arm.upper_ws.position).norm();
        const double forearm_m = (arm.hand_ws.position - arm.forearm_ws.position).norm();
        EXPECT_LT((bone_end(arm.upper_ws, upper_m) - arm.forearm_ws.position).norm(), 1e-9);
        EXPECT_LT((bone_end(arm.forearm_ws, forearm_m) - arm.hand_ws.position).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace handhold::shown_offset_test
