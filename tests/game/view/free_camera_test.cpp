#include "game/view/free_camera.hpp"

#include <gtest/gtest.h>

namespace handhold::free_camera_test {
namespace {

FreeCamera begun(const Vec3& up_ws = Vec3::UnitY()) {
    FreeCamera camera;
    camera.begin({Vec3(1.0, 2.0, 3.0), Quat::Identity()}, up_ws, {});
    return camera;
}

TEST(FreeCamera, FliesInItsViewDirection) {
    FreeCamera camera = begun();
    DesktopInput left;
    left.turn_left_rad = k_half_pi;
    camera.fly(left, 0.01);
    DesktopInput ahead;
    ahead.move = -hh::k_z;
    camera.fly(ahead, 1.0);
    EXPECT_NEAR((camera.pose_ws().position - Vec3(-0.5, 2.0, 3.0)).norm(), 0.0, 1e-12);
    ahead.hurry = true;
    camera.fly(ahead, 1.0);
    EXPECT_LT(camera.pose_ws().position.x(), -5.0);
}

// For any mouse movement, the horizon stays level and the camera never tips over.
TEST(FreeCamera, StaysUpright) {
    const Vec3 up = Vec3(0.3, 1.0, -0.4).normalized();
    FreeCamera camera = begun(up);
    DesktopInput input;
    input.look_up_rad = 0.4;
    input.turn_left_rad = 0.3;
    for (int i = 0; i < 200; ++i) {
        camera.fly(input, 1.0 / 90.0);
        EXPECT_NEAR((camera.pose_ws().rotation * Vec3::UnitX()).dot(up), 0.0, 1e-9);
        EXPECT_GT((camera.pose_ws().rotation * Vec3::UnitY()).dot(up), 0.05);
    }
    EXPECT_NEAR((camera.pose_ws().rotation * -Vec3::UnitZ()).dot(up), sine(85.0 * k_degree), 1e-9);
}

TEST(FreeCamera, PlayerKeepsGripsAndDoesNothingElse) {
    DesktopInput input;
    input.grip = {true, false};
    input.move = hh::k_x;
    input.brake = true;
    FreeCamera camera;
    camera.begin({}, Vec3::UnitY(), input);
    input.grip = {false, true};
    camera.fly(input, 0.1);
    const DesktopInput held = camera.held();
    EXPECT_TRUE(held.grip[0]);
    EXPECT_FALSE(held.grip[1]);
    EXPECT_TRUE(held.move == hh::Vec3{});
    EXPECT_FALSE(held.brake);
}

TEST(FreeCamera, StartsLevelForAnyEyePose) {
    FreeCamera camera;
    for (const double pitch : {k_half_pi, -k_half_pi, 0.3}) {
        const Quat look = rotation_about(Vec3::UnitX(), pitch) * rotation_about(Vec3::UnitZ(), 1.0);
        camera.begin({Vec3::Zero(), look}, Vec3::UnitY(), {});
        EXPECT_TRUE(is_valid(camera.pose_ws()));
        EXPECT_NEAR((camera.pose_ws().rotation * Vec3::UnitX()).y(), 0.0, 1e-9);
        DesktopInput down;
        down.look_up_rad = -0.1;
        camera.fly(down, 0.1);
        EXPECT_TRUE(is_valid(camera.pose_ws()));
    }
}

}  // namespace
}  // namespace handhold::free_camera_test
