// The arithmetic of a camera's picture.
#include "game/render/frame_view.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "game/scene/random.hpp"

namespace handhold::frame_view_test {
namespace {

FrameView lopsided_view() {
    Camera camera;
    camera.pose_ws = {Vec3(3.0, -2.0, 1.0),
                      (rotation_about(Vec3::UnitY(), 0.7) * rotation_about(Vec3::UnitX(), -0.3))};
    camera.frustum = EyeFrustum{-1.3, 0.7, -1.1, 0.9};
    return make_frame_view(camera, 100, 100);
}

// Points on the frustum's sides project to the picture's sides: the pinhole's closed form.
TEST(FrameView, AsymmetricFrustumsCornersAreThePicturesCorners) {
    const FrameView view = lopsided_view();
    for (const auto& [x, y, clip_x, clip_y] :
         {std::array{-1.3, -1.1, -1.0, -1.0}, std::array{0.7, 0.9, 1.0, 1.0},
          std::array{-0.3, -0.1, 0.0, 0.0}, std::array{0.7, -0.1, 1.0, 0.0}}) {
        for (const double distance_m : {0.1, 5.0}) {
            const Vec3 point = view.from_view * (distance_m * Vec3(x, y, -1.0));
            const std::array<double, 4> clip = to_clip(view, point);
            EXPECT_NEAR(clip[0] / clip[3], clip_x, 1e-12);
            EXPECT_NEAR(clip[1] / clip[3], clip_y, 1e-12);
        }
    }
}

TEST(FrameView, MatrixAndPointsAgree) {
    const FrameView view = lopsided_view();
    const Vec3 point(0.4, -1.7, -2.1);
    const std::array<double, 4> clip = to_clip(view, point);
    for (std::size_t row = 0; row < 4; ++row) {
        double sum = static_cast<double>(view.cs_to_clip[12 + row]);
        for (std::size_t column = 0; column < 3; ++column) {
            sum += static_cast<double>(view.cs_to_clip[4 * column + row]) *
                   point[static_cast<Eigen::Index>(column)];
        }
        EXPECT_NEAR(sum, clip[row], 1e-5);
    }
}

// Spheres with their centre in the picture are visible; spheres entirely beyond one of the four
// side planes are not.
TEST(FrameView, CullsExactlyOutsideTheFourPlanes) {
    const FrameView view = lopsided_view();
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const double distance_m = random.between(0.1, 20.0);
        const double x = random.between(-3.0, 3.0);
        const double y = random.between(-3.0, 3.0);
        const Vec3 center = view.from_view * (distance_m * Vec3(x, y, -1.0));
        const bool inside = x > -1.3 && x < 0.7 && y > -1.1 && y < 0.9;
        EXPECT_EQ(sees_sphere(view, center, 1e-9), inside) << x << " " << y;
        // Beyond a side plane by d: a sphere of radius just below d is outside, just above is not.
        const double beyond = (x - 0.7) * distance_m / std::sqrt(1.0 + 0.49);
        if (beyond > 0.05 && y > -1.0 && y < 0.8) {
            EXPECT_FALSE(sees_sphere(view, center, 0.999 * beyond));
            EXPECT_TRUE(sees_sphere(view, center, 1.001 * beyond));
        }
    }
}

}  // namespace
}  // namespace handhold::frame_view_test
