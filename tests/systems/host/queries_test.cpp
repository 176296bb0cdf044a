// Queries of the C interface, against closed forms and columns.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/ecs.hpp>
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_queries_test {
namespace {

using namespace test;

TEST(HostQueries, FindWallWhereItIs) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();  // its face is at z = -0.5
    const auto ray = scene.world.cast_ray({0.0, 1.5, 0.5}, {0.0, 1.5, -1.5});
    ASSERT_TRUE(ray);
    EXPECT_TRUE(ray->body == wall);
    EXPECT_EQ(ray->player.generation, 0U);
    EXPECT_NEAR(ray->point.z, -0.5, 1e-12);
    EXPECT_NEAR(hh::length(ray->normal - hh::k_z), 0.0, 1e-12);
    EXPECT_NEAR(ray->distance_m, 1.0, 1e-12);
    const auto ball = scene.world.cast_sphere(0.1, {0.0, 1.5, 0.5}, {0.0, 1.5, -1.5});
    ASSERT_TRUE(ball);
    EXPECT_NEAR(ball->distance_m, 0.9, 1e-6);
    const auto near = scene.world.closest_point({0.3, 1.0, -0.2}, 0.5);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->distance_m, 0.3, 1e-12);
    EXPECT_NEAR(hh::length(near->point - hh::Vec3{0.3, 1.0, -0.5}), 0.0, 1e-12);
    EXPECT_FALSE(scene.world.closest_point({0.3, 1.0, -0.2}, 0.29));
    EXPECT_FALSE(scene.world.cast_ray({0.0, 1.5, 0.5}, {0.0, 1.5, -0.4}));
}

TEST(HostQueries, SeeEveryChangeSinceTheQueryBefore) {
    HostScene scene;
    const hh::Body wall = scene.add_wall();
    const auto at_m = [&] {
        const auto hit = scene.world.cast_ray({0.0, 1.5, 0.0}, {0.0, 1.5, -9.0});
        return hit ? hit->distance_m : -1.0;
    };
    EXPECT_NEAR(at_m(), 0.5, 1e-12);
    ASSERT_TRUE(scene.world.teleport(wall, hh::pose_at({0.0, 1.5, -2.1})));
    EXPECT_NEAR(at_m(), 2.0, 1e-12);
    columns_of(scene.world.get()).world.body_pose.at(entity_of(wall)).pose_ws.position.z() = -3.1;
    EXPECT_NEAR(at_m(), 3.0, 1e-12);
    ASSERT_TRUE(scene.world.remove(wall));
    EXPECT_EQ(at_m(), -1.0);
}

TEST(HostQueries, FindHeadsExceptTheSkippedPlayers) {
    HostScene scene;
    scene.step(2);
    hh::Vec3 center{};
    double radius_m = 0.0;
    std::uint8_t is_tracked = 0;
    ASSERT_EQ(hh_player_head(scene.world.get(), scene.player, &center, &radius_m, &is_tracked),
              HH_OK);
    EXPECT_TRUE(is_tracked);
    const hh::Vec3 from = center + hh::Vec3{0.0, 0.0, 2.0};
    const auto hit = scene.world.cast_ray(from, center);
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->player == scene.player);
    EXPECT_EQ(hit->body.generation, 0U);
    EXPECT_NEAR(hit->distance_m, 2.0 - radius_m, 1e-6);
    EXPECT_FALSE(scene.world.cast_ray(from, center, scene.player));
    EXPECT_FALSE(scene.world.closest_point(center, 0.5, scene.player));
    std::vector<hh::Hit> hits;
    ASSERT_TRUE(scene.world.overlap_sphere(center, 0.5, hits, scene.player));
    EXPECT_TRUE(hits.empty());
    ASSERT_TRUE(scene.world.overlap_sphere(center, 0.5, hits));
    ASSERT_EQ(hits.size(), 1U);
    EXPECT_TRUE(hits[0].player == scene.player);
}

// Spheres have closed forms.
RC_GTEST_PROP(HostQueries, AgreeWithClosedFormsAmongSpheres, ()) {
    const auto number = [](double limit) {
        return limit * (*rc::gen::inRange(-1000, 1001)) * 1e-3;
    };
    const auto point = [&](double limit) {
        const double x = number(limit);
        const double y = number(limit);
        return hh::Vec3{x, y, number(limit)};
    };
    hh_world_def def_of_world = hh::world_def();
    def_of_world.fits_hands = false;  // no grip mesh a ball
    hh::World world(def_of_world);
    struct Ball {
        hh::Body body;
        hh::Vec3 at;
        double radius_m;
    };
    std::vector<Ball> balls;
    const int count = *rc::gen::inRange(1, 12);
    for (int i = 0; i < count; ++i) {
        Ball ball{{}, point(3.0), 0.1 + std::abs(number(0.5))};
        hh_body_def def = hh::body_def();
        def.shape = *world.add_sphere(ball.radius_m);
        def.pose.position = ball.at;
        ball.body = *world.add(def);
        balls.push_back(ball);
    }
    const hh::Vec3 center = point(4.0);
    const double reach_m = std::abs(number(2.0));
    const auto distance_m = [&](const Ball& ball) {
        return std::max(0.0, hh::length(ball.at - center) - ball.radius_m);
    };
    const auto nearest = std::ranges::min_element(balls, {}, distance_m);
    RC_PRE(std::ranges::all_of(
        balls, [&](const Ball& b) { return std::abs(distance_m(b) - reach_m) > 1e-6; }));
    const auto found = world.closest_point(center, reach_m);
    RC_ASSERT(found.has_value() == (distance_m(*nearest) <= reach_m));
    if (found) {
        RC_ASSERT(std::abs(found->distance_m - distance_m(*nearest)) < 1e-6);
    }
    std::vector<hh::Hit> hits;
    RC_ASSERT(static_cast<bool>(world.overlap_sphere(center, reach_m, hits)));
    for (const Ball& ball : balls) {
        const bool is_listed =
            std::ranges::any_of(hits, [&](const hh::Hit& hit) { return hit.body == ball.body; });
        RC_ASSERT(is_listed == (distance_m(ball) <= reach_m));
    }
    const hh::Vec3 to = point(4.0);
    const hh::Vec3 way = to - center;
    RC_PRE(hh::length(way) > 1e-3);
    double first_m = 1e9;
    for (const Ball& ball : balls) {  // |center + s way - at| = radius
        const hh::Vec3 off = center - ball.at;
        const hh::Vec3 along = hh::normalized(way);
        const double b = hh::dot(off, along);
        const double under = b * b - hh::dot(off, off) + ball.radius_m * ball.radius_m;
        RC_PRE(std::abs(under) > 1e-4);  // not tangential
        for (const double sign : {-1.0, 1.0}) {
            const double s = under > 0.0 ? -b + sign * std::sqrt(under) : -1.0;
            RC_PRE(std::abs(s) > 1e-4 && std::abs(s - hh::length(way)) > 1e-4);
            if (s > 0.0 && s < hh::length(way)) {
                first_m = std::min(first_m, s);
            }
        }
    }
    const auto hit = world.cast_ray(center, to);
    RC_ASSERT(hit.has_value() == (first_m < 1e9));
    if (hit) {
        RC_ASSERT(std::abs(hit->distance_m - first_m) < 1e-5);
    }
}

TEST(HostQueries, NeverChangeAStep) {
    HostScene asks;
    HostScene steps;
    for (HostScene* scene : {&asks, &steps}) {
        scene->add_wall();
        hh_body_def def = crate(scene->world, {0.2, 1.4, -0.3});
        def.velocity_mps = {0.3, 0.1, -1.0};
        ASSERT_TRUE(scene->world.add(def));
    }
    for (int i = 0; i < 60; ++i) {
        EXPECT_TRUE(asks.world.closest_point({0.0, 1.5, 0.0}, 3.0));
        asks.closed[HH_RIGHT] = steps.closed[HH_RIGHT] = i > 20;
        asks.step();
        steps.step();
        ASSERT_EQ(asks.world.hash(), steps.world.hash()) << i;
    }
}

TEST(HostQueries, AreRefusedInsideAStep) {
    HostScene scene;
    scene.add_wall();
    const hh::Sample sample = scene.sample();
    const hh_player_input input = hh::input(scene.player, {&sample, 1});
    ASSERT_TRUE(scene.world.begin_step(k_step_s, {&input, 1}));
    hh::Hit hit{};
    EXPECT_EQ(hh_world_cast_ray(scene.world.get(), {}, {0.0, 0.0, -1.0}, {}, &hit), HH_ERROR_STATE);
    ASSERT_TRUE(scene.world.end_step({}));
    EXPECT_EQ(hh_world_cast_ray(scene.world.get(), {}, {0.0, 0.0, -1.0}, {}, &hit), HH_OK);
    EXPECT_EQ(hh_world_cast_ray(scene.world.get(), {}, {std::nan(""), 0.0, -1.0}, {}, &hit),
              HH_ERROR_VALUE);
    EXPECT_EQ(hh_world_cast_ray(scene.world.get(), {}, {0.0, 0.0, -1.0}, {99, 1}, &hit),
              HH_ERROR_HANDLE);
}

}  // namespace
}  // namespace handhold::host_queries_test
