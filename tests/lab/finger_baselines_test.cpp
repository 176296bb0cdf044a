// The baselines for closing fingers, against closed forms: planes and tangents of circles.
#include "tools/lab/finger_baselines.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace handhold::lab::finger_baselines_test {
namespace {

constexpr double k_pi = std::numbers::pi;

// A finger at the origin along -Z that closes towards -Y (down).
HingeChain make_chain(double height_m, std::uint32_t links = 3) {
    HingeChain chain;
    chain.base.position = Vec3(0.0, height_m, 0.0);
    chain.link_count = links;
    chain.length_m = {0.04, 0.045, 0.03};
    chain.radius_m = {0.009, 0.008, 0.007};
    chain.open_rad = {0.0, 0.0, 0.0};
    chain.closed_rad = {2.0, 2.0, 2.0};
    chain.rest_rad = {0.3, 0.5, 0.2};
    return chain;
}

GripMesh as_it_is(const Mesh& mesh) {
    GripMeshSettings settings;
    settings.contact.deviation_m = 0.0;
    return build_grip_mesh(mesh, settings);
}

// A rectangle of two triangles around the origin in the plane y = 0.
GripMesh make_floor(double half_x_m = 1.0, double half_z_m = 1.0, double z_m = 0.0) {
    Mesh mesh;
    mesh.positions = {Vec3(-half_x_m, 0, z_m - half_z_m), Vec3(half_x_m, 0, z_m - half_z_m),
                      Vec3(half_x_m, 0, z_m + half_z_m), Vec3(-half_x_m, 0, z_m + half_z_m)};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return as_it_is(mesh);
}

// A tube around an axis along x.
GripMesh make_tube(const Vec3& middle, double radius_m, int sides) {
    Mesh mesh;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * k_pi * i / sides;
        for (const double x : {-0.2, 0.2}) {
            mesh.positions.emplace_back(
                middle + Vec3(x, radius_m * std::cos(angle), radius_m * std::sin(angle)));
        }
        const auto here = static_cast<std::uint32_t>(2 * i);
        const auto next = static_cast<std::uint32_t>(2 * ((i + 1) % sides));
        mesh.triangles.push_back({here, next, next + 1});
        mesh.triangles.push_back({here, next + 1, here + 1});
    }
    return as_it_is(mesh);
}

ClosedFinger close_by_talk(const HingeChain& chain, const GripMesh& mesh) {
    ChainFitScratch scratch;
    const auto near = mesh.search_bvh.closest_point(chain.base.position, 1.0);
    return lab::close_by_talk(chain, mesh, {near->triangle, near->point},
                              lab::SearchOrder::best_first, scratch);
}

double sum_of_lengths(const HingeChain& chain) {
    return chain.length_m[0] + chain.length_m[1] + chain.length_m[2];
}

TEST(CloseOnCrossings, StraightFingerStopsOnALineAtAsinOfHeightOverReach) {
    const HingeChain chain = make_chain(0.0);
    for (const double height_m : {0.01, 0.05, 0.1}) {
        const std::array<Vec2, 2> line = {Vec2(-1.0, height_m), Vec2(1.0, height_m)};
        const ClosedFinger closed = close_on_crossings(chain, line);
        EXPECT_NEAR(closed.angle_rad[0], std::asin(height_m / sum_of_lengths(chain)), 1e-9);
        EXPECT_NEAR(closed.angle_rad[1], 0.0, 1e-7);
        EXPECT_NEAR(closed.angle_rad[2], 0.0, 1e-7);
        EXPECT_EQ(closed.contact_link, 2);
    }
}

TEST(CloseOnCrossings, LineOutOfReachGivesRestPose) {
    const HingeChain chain = make_chain(0.0);
    const double height_m = sum_of_lengths(chain) + 1e-6;
    const std::array<Vec2, 2> line = {Vec2(-1.0, height_m), Vec2(1.0, height_m)};
    const ClosedFinger closed = close_on_crossings(chain, line);
    EXPECT_EQ(closed.contact_link, DiscClosure::k_none);
    EXPECT_EQ(closed.angle_rad, chain.rest_rad);
}

TEST(CloseOnCrossings, FirstCrossingBelowTheStartStopsTheFinger) {
    const HingeChain chain = make_chain(0.0, 1);
    const auto at = [](double angle_rad) {
        return Vec2(0.03 * std::cos(angle_rad), 0.03 * std::sin(angle_rad));
    };
    const std::array<Vec2, 3> line = {at(-0.4), at(0.9), at(0.6)};
    const ClosedFinger closed = close_on_crossings(chain, line);
    EXPECT_NEAR(closed.angle_rad[0], 0.6, 1e-12);
}

// If the tangent from the first hinge touches before the link ends, the next link lies along the
// other tangent through its hinge. It turns by pi - 2 atan(R / s), s: distance from the touch to
// the hinge.
TEST(CloseOnCrossings, LinksWrapACircleAlongItsTangents) {
    const HingeChain chain = make_chain(0.0);
    const double radius_m = 0.02;
    const double touch_m = 0.02;  // along the tangent, from the first hinge
    const double slope_rad = 0.5;
    const Vec2 along(std::cos(slope_rad), std::sin(slope_rad));
    const Vec2 middle = touch_m * along + radius_m * Vec2(-along.y(), along.x());
    constexpr int k_points = 20000;
    std::vector<Vec2> line;
    for (int i = 0; i <= k_points; ++i) {
        const double angle = 2.0 * k_pi * i / k_points;
        line.emplace_back(middle + radius_m * Vec2(std::cos(angle), std::sin(angle)));
    }
    const double first_m = chain.length_m[0] - touch_m;
    const double second_m = chain.length_m[1] - first_m;
    const ClosedFinger closed = close_on_crossings(chain, line);
    EXPECT_NEAR(closed.angle_rad[0], slope_rad, 1e-5);
    EXPECT_NEAR(closed.angle_rad[1], k_pi - 2.0 * std::atan(radius_m / first_m), 1e-4);
    EXPECT_NEAR(closed.angle_rad[2], k_pi - 2.0 * std::atan(radius_m / second_m), 1e-4);
    EXPECT_EQ(closed.contact_link, 2);
}

TEST(CloseByTalk, TipAxisLiesOnAFloor) {
    const HingeChain chain = make_chain(0.04);
    const ClosedFinger closed = close_by_talk(chain, make_floor());
    EXPECT_NEAR(closed.angle_rad[0], std::asin(0.04 / sum_of_lengths(chain)), 1e-7);
    EXPECT_EQ(closed.discs, 1U);
    EXPECT_GE(closed.pops, 1U);
    EXPECT_GE(closed.walked, 2U);
    const auto capsules = chain_capsules(chain, closed.angle_rad);
    EXPECT_NEAR(capsules[2].ends[1].y(), 0.0, 1e-7);
}

TEST(CloseByTalk, FirstLinkIsTangentToATube) {
    const HingeChain chain = make_chain(0.0);
    const Vec3 middle(0.0, -0.035, -0.03);
    const double radius_m = 0.02;
    const int sides = 256;
    const ClosedFinger closed = close_by_talk(chain, make_tube(middle, radius_m, sides));
    const double away_m = middle.norm();
    const double expected = std::atan2(-middle.y(), -middle.z()) - std::asin(radius_m / away_m);
    const double touch_m = std::sqrt(away_m * away_m - radius_m * radius_m);
    const double inside_m = radius_m * (1.0 - std::cos(k_pi / sides));  // centre of a side
    EXPECT_NEAR(closed.angle_rad[0], expected, inside_m / touch_m);
    EXPECT_GE(closed.contact_link, 0);
}

TEST(CloseByTalk, FingerTouchesTheHighestEdgeOfAStrip) {
    const HingeChain chain = make_chain(0.02);
    const ClosedFinger on_floor = close_by_talk(chain, make_floor());
    const ClosedFinger on_strip = close_by_talk(chain, make_floor(1.0, 0.005, -0.05));
    // The strip's far edge, 55 mm away and 20 mm down.
    EXPECT_NEAR(on_strip.angle_rad[0], std::atan2(0.02, 0.055), 1e-7);
    EXPECT_NEAR(on_floor.angle_rad[0], std::asin(0.02 / sum_of_lengths(chain)), 1e-7);
}

TEST(CloseBySpheres, LinkStopsAtTheLastStepAboveAFloor) {
    for (const double height_m : {0.012, 0.02, 0.03, 0.045}) {
        const HingeChain chain = make_chain(height_m, 1);
        const double touch_rad = std::asin((height_m - chain.radius_m[0]) / chain.length_m[0]);
        const double step_rad = chain.closed_rad[0] / 50.0;
        const ClosedFinger closed = close_by_spheres(chain, make_floor());
        EXPECT_NEAR(closed.angle_rad[0], std::floor(touch_rad / step_rad) * step_rad, 1e-12);
        EXPECT_EQ(closed.contact_link, 0);
    }
}

TEST(CloseBySpheres, LinksBeyondTheTouchingOneKeepClosing) {
    const HingeChain chain = make_chain(0.012);  // the first link's end touches first
    const GripMesh post = make_floor(1.0, 0.005, -0.04);
    const ClosedFinger closed = close_by_spheres(chain, post);
    EXPECT_LT(closed.angle_rad[0], 0.2);
    EXPECT_GT(closed.angle_rad[1], closed.angle_rad[0]);
}

TEST(CloseBySpheres, PassesThroughABladeBetweenTwoSpheres) {
    const HingeChain chain = make_chain(0.02, 1);
    HingeChain thin = chain;
    thin.radius_m = {0.002, 0.002, 0.002};
    // A blade on edge under the link's third quarter, wide across the finger.
    Mesh blade;
    blade.positions = {Vec3(-0.1, 0.0, -0.03), Vec3(0.1, 0.0, -0.03), Vec3(0.0, 0.002, -0.03)};
    blade.triangles = {{0, 1, 2}};
    const GripMesh mesh = as_it_is(blade);
    // The link sweeps over the blade: asin(20 mm / 36 mm) is within its range, which its end never
    // reaches.
    EXPECT_EQ(close_by_spheres(thin, mesh).contact_link, DiscClosure::k_none);
    EXPECT_EQ(close_by_talk(thin, mesh).contact_link, 0);
}

TEST(CloseBySpheres, NothingInReachGivesRestPose) {
    const HingeChain chain = make_chain(0.5);
    EXPECT_EQ(close_by_spheres(chain, make_floor()).angle_rad, chain.rest_rad);
}

}  // namespace
}  // namespace handhold::lab::finger_baselines_test
