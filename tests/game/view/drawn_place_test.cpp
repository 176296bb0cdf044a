// Players of a match, drawn between ticks.
#include "game/view/drawn_place.hpp"

#include <gtest/gtest.h>

namespace handhold::drawn_place_test {
namespace {

// Arms that hang straight down from shoulders at 1.4 m, with bones of 0.3 m.
RenderPose standing() {
    RenderPose pose;
    pose.head_ws.position = {0.0, 1.6, 0.0};
    pose.head_center_ws = {0.0, 1.65, 0.08};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double x = side == 0 ? -0.2 : 0.2;
        const Quat down = rotation_between(-Vec3::UnitZ(), -Vec3::UnitY());
        ArmPose::Arm& arm = pose.arms.arms[side];
        arm.upper_ws = {Vec3(x, 1.4, 0.0), down};
        arm.forearm_ws = {Vec3(x, 1.1, 0.0), down};
        arm.hand_ws = {Vec3(x, 0.8, 0.0), down};
        RenderPose::Hand& hand = pose.hands[side];
        hand.shown_ws = arm.hand_ws;
        hand.tracked_ws = {Vec3(x, 0.82, 0.01), down};
        hand.ray_from_ws = Vec3(x, 0.75, 0.0);
        hand.ray_to_ws = Vec3(x, 0.65, -0.1);
    }
    return pose;
}

DrawnPlace place_of(const RenderPose& pose) {
    return {pose.head_ws, {pose.hands[0].shown_ws, pose.hands[1].shown_ws}};
}

DrawnPlace moved_place() {
    DrawnPlace place = place_of(standing());
    place.head_ws = place.head_ws * Pose{Vec3(0.05, 0.0, 0.0), rotation_about(Vec3::UnitY(), 0.3)};
    place.wrists_ws[0].position += Vec3(0.0, 0.02, 0.03);
    place.wrists_ws[1] =
        Pose{Vec3(-0.1, 0.05, 0.2), rotation_about(Vec3::UnitX(), 0.2)} * place.wrists_ws[1];
    return place;
}

Vec3 bone_end(const Pose& bone_ws, double length_m) {
    return bone_ws.position + length_m * (bone_ws.rotation * -Vec3::UnitZ());
}

double distance(const Pose& a, const Pose& b) {
    return (a.position - b.position).norm() + a.rotation.angularDistance(b.rotation);
}

TEST(DrawnPlace, TheOwnPlaceChangesNothing) {
    const RenderPose pose = standing();
    const RenderPose drawn = drawn_at(pose, place_of(pose));
    EXPECT_LT(distance(drawn.head_ws, pose.head_ws), 1e-9);
    EXPECT_LT((drawn.head_center_ws - pose.head_center_ws).norm(), 1e-9);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ArmPose::Arm& arm = drawn.arms.arms[side];
        EXPECT_LT(distance(arm.upper_ws, pose.arms.arms[side].upper_ws), 1e-6);
        EXPECT_LT(distance(arm.forearm_ws, pose.arms.arms[side].forearm_ws), 1e-6);
        EXPECT_LT(distance(drawn.hands[side].tracked_ws, pose.hands[side].tracked_ws), 1e-6);
    }
}

TEST(DrawnPlace, ArmsStillLeadFromTheBodyToTheHands) {
    const DrawnPlace place = moved_place();
    const RenderPose drawn = drawn_at(standing(), place);
    EXPECT_EQ(drawn.head_ws.position, place.head_ws.position);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ArmPose::Arm& arm = drawn.arms.arms[side];
        EXPECT_EQ(arm.hand_ws.position, place.wrists_ws[side].position);
        EXPECT_EQ(drawn.hands[side].shown_ws.position, arm.hand_ws.position);
        const double upper_m = (arm.forearm_ws.position - arm.upper_ws.position).norm();
        const double forearm_m = (arm.hand_ws.position - arm.forearm_ws.position).norm();
        EXPECT_LT((bone_end(arm.upper_ws, upper_m) - arm.forearm_ws.position).norm(), 1e-9);
        EXPECT_LT((bone_end(arm.forearm_ws, forearm_m) - arm.hand_ws.position).norm(), 1e-9);
    }
}

// Head and wrists keep the parts that are fixed to them.
TEST(DrawnPlace, CarriesWhatIsFixedToHeadAndWrists) {
    const RenderPose pose = standing();
    const RenderPose drawn = drawn_at(pose, moved_place());
    EXPECT_LT((transform_point(inverse(drawn.head_ws), drawn.head_center_ws) -
               transform_point(inverse(pose.head_ws), pose.head_center_ws))
                  .norm(),
              1e-9);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const RenderPose::Hand& before = pose.hands[side];
        const RenderPose::Hand& after = drawn.hands[side];
        EXPECT_LT(distance(inverse(after.shown_ws) * after.tracked_ws,
                           inverse(before.shown_ws) * before.tracked_ws),
                  1e-6);
        EXPECT_LT((transform_point(inverse(after.shown_ws), after.ray_to_ws) -
                   transform_point(inverse(before.shown_ws), before.ray_to_ws))
                      .norm(),
                  1e-9);
    }
}

}  // namespace
}  // namespace handhold::drawn_place_test
