#include "game/view/outside_camera.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/game/climber/climber_scene.hpp"

namespace handhold::outside_camera_test {
namespace {

// A head in the tunnel, which is 2 m wide and high, looking along it.
RenderPose head_at(const Vec3& place) {
    RenderPose render;
    render.head_ws.position = place;
    return render;
}

double ahead_share(const Pose& camera, const Vec3& target) {
    return (camera.rotation * -Vec3::UnitZ()).dot((target - camera.position).normalized());
}

TEST(OutsideCamera, StaysInsideTheWallsAndLooksAtThePlayer) {
    const Scene scene = make_tunnel(4.0);
    OutsideCamera outside(scene);
    for (const double x : {-0.8, 0.0, 0.8}) {
        for (const double z : {-3.6, 0.0, 3.6}) {
            const RenderPose player = head_at(Vec3(x, 0.5, z));
            for (const Pose& camera : {outside.behind(player), outside.before(player)}) {
                EXPECT_LT(std::abs(camera.position.x()), 1.0);
                EXPECT_LT(std::abs(camera.position.y()), 1.0);
                EXPECT_LT(std::abs(camera.position.z()), 3.9);
                EXPECT_GT(ahead_share(camera, player.head_ws.position), 0.7) << x << " " << z;
            }
        }
    }
}

TEST(OutsideCamera, IsBehindOrInFrontWithoutWalls) {
    const Scene scene = make_void();
    OutsideCamera outside(scene);
    const RenderPose player = head_at(Vec3(5.0, 1.0, 2.0));
    EXPECT_GT(outside.behind(player).position.z(), 2.5);
    EXPECT_LT(outside.before(player).position.z(), 1.0);
}

// Also if the player looks straight up, and beside bodies without colliders.
TEST(OutsideCamera, IsValidForAnyLookAndForBodiesWithoutColliders) {
    Scene scene = make_tunnel(4.0);
    const Entity ghost = add_block(scene, "ghost", Vec3(0.1, 0.1, 0.1), Vec3::Zero());
    ASSERT_TRUE(scene.world().collider.remove(ghost));
    OutsideCamera outside(scene);
    RenderPose player = head_at(Vec3::Zero());
    for (const double pitch : {k_half_pi, -k_half_pi}) {
        player.head_ws.rotation = rotation_about(Vec3::UnitX(), pitch);
        EXPECT_TRUE(is_valid(outside.behind(player)));
        EXPECT_TRUE(is_valid(outside.before(player)));
    }
}

}  // namespace
}  // namespace handhold::outside_camera_test
