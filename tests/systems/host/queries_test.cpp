// Queries and getters of the C interface, against closed forms and columns.
#include <algorithm>
#include <array>
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

TEST(HostGetters, SayWhatDefinitionsSaid) {
    hh_world_def def = hh::world_def();
    def.gravity_mps2 = {0.0, -9.81, 0.0};
    def.reference_velocity_mps = {1.0, 2.0, 3.0};
    hh::World world(def);
    hh::Vec3 gravity{};
    ASSERT_EQ(hh_world_gravity(world.get(), &gravity), HH_OK);
    EXPECT_EQ(gravity.y, -9.81);
    EXPECT_TRUE(world.reference_velocity_mps() == (hh::Vec3{1.0, 2.0, 3.0}));
    hh_body_def body = crate(world, {});
    const hh::Body dynamic = *world.add(body);
    body.kind = HH_KINEMATIC;
    const hh::Body kinematic = *world.add(body);
    EXPECT_EQ(*world.kind(dynamic), HH_DYNAMIC);
    EXPECT_EQ(*world.kind(kinematic), HH_KINEMATIC);
    EXPECT_EQ(*world.mass_kg(dynamic), 2.0);
    EXPECT_EQ(*world.mass_kg(kinematic), 0.0);
    EXPECT_EQ(world.bodies().size(), 2U);
    std::size_t count = 9;
    EXPECT_EQ(hh_body_joints(world.get(), dynamic, nullptr, 0, &count), HH_OK);
    EXPECT_EQ(count, 0U);
    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = dynamic;
    const hh::Joint joint = *world.add(hinge);
    hh::Joint found{};
    ASSERT_EQ(hh_body_joints(world.get(), dynamic, &found, 1, &count), HH_OK);
    EXPECT_TRUE(found == joint);
    EXPECT_EQ(hh_body_joints(world.get(), dynamic, &found, 0, &count), HH_ERROR_CAPACITY);
}

// A static wall moves its player, a loose crate does not, a crate on a hinge does.
TEST(HostHands, SayWhetherTheyMoveTheirPlayer) {
    for (const int what : {0, 1, 2}) {
        HostScene scene;
        if (what == 0) {
            scene.add_wall();
        } else {
            const hh::Body body = *scene.world.add(crate(scene.world, {0.2, 1.4, -0.56}));
            if (what == 2) {
                hh_joint_def hinge = hh::joint_def();
                hinge.kind = HH_HINGE;
                hinge.body_b = body;
                hinge.frame.position = {0.2, 1.4, -0.8};
                ASSERT_TRUE(scene.world.add(hinge));
            }
        }
        scene.step(3);
        EXPECT_FALSE(scene.world.moves_player(scene.player, HH_RIGHT));
        scene.closed[HH_RIGHT] = true;
        scene.step(3);
        ASSERT_NE(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE) << what;
        EXPECT_EQ(scene.world.moves_player(scene.player, HH_RIGHT), what != 1) << what;
    }
}

TEST(HostPlayers, ReferenceVelocityIsThatOfTheLastGrip) {
    HostScene scene;
    hh_body_def lift = hh::body_def();
    lift.kind = HH_KINEMATIC;
    lift.shape = *scene.world.add_box({2.0, 2.0, 0.1});
    lift.pose.position = {0.0, 1.5, -0.6};
    const hh::Body body = *scene.world.add(lift);
    EXPECT_TRUE(*scene.world.reference_velocity_mps(scene.player) == hh::Vec3{});
    scene.closed[HH_RIGHT] = true;
    for (int i = 1; i < 20; ++i) {
        lift.pose.position.y += 0.5 * k_step_s;
        ASSERT_TRUE(scene.world.move_kinematic(body, lift.pose));
        scene.step();
    }
    EXPECT_NEAR(scene.world.reference_velocity_mps(scene.player)->y, 0.5, 1e-9);
}

TEST(HostPlayers, HandInControllerOfTheTuningIsThatOfPlayersWithoutTheirOwn) {
    hh::World world;
    const hh::Player player = *world.add(hh::player_def());
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        EXPECT_TRUE(world.hand_in_controller(side)->rotation ==
                    world.hand_in_controller(player, side)->rotation);
        EXPECT_TRUE(world.hand_in_controller(side)->position ==
                    world.hand_in_controller(player, side)->position);
    }
    ASSERT_TRUE(world.use_wrists(player));
    EXPECT_TRUE(world.hand_in_controller(player, HH_LEFT)->position == hh::Vec3{});
    EXPECT_FALSE(world.hand_in_controller(HH_LEFT)->position == hh::Vec3{});
}

// A player drifts head first into a wall. Without drag and contacts the origin would move by
// velocity times time, so the push-back is the distance from there to the origin after the step.
TEST(HostPlayers, PushBackIsHowFarContactsMovedTheOrigin) {
    HostScene scene;
    ASSERT_TRUE(scene.world.tune("locomotion.drift_drag_per_s", 0.0));
    scene.add_wall();
    scene.step(3);
    EXPECT_EQ(*scene.world.mass_kg(scene.player), 80.0);
    EXPECT_EQ(*scene.world.push_back_m(scene.player), 0.0);
    ASSERT_EQ(hh_player_set_velocity(scene.world.get(), scene.player, {0.0, 0.0, -1.0}), HH_OK);
    double most_m = 0.0;
    for (int i = 0; i < 60; ++i) {
        const hh_player_pose before = *scene.world.pose(scene.player);
        scene.step();
        const hh::Vec3 free = before.origin.position + k_step_s * before.velocity_mps;
        const hh::Vec3 after = scene.world.pose(scene.player)->origin.position;
        const double pushed_m = *scene.world.push_back_m(scene.player);
        EXPECT_NEAR(pushed_m, hh::length(after - free), 1e-9) << i;
        most_m = std::max(most_m, pushed_m);
    }
    EXPECT_GT(most_m, 1e-3);
}

TEST(HostThreads, MayChangeWhileAWorldExists) {
    const hh::World world;
    const std::uint32_t before = hh_thread_count();
    ASSERT_EQ(hh_set_thread_count(3), HH_OK);
    EXPECT_EQ(hh_thread_count(), 3U);
    EXPECT_EQ(hh_set_thread_count(0), HH_ERROR_VALUE);
    EXPECT_EQ(hh_set_thread_count(257), HH_ERROR_VALUE);
    EXPECT_EQ(hh_thread_count(), 3U);
    ASSERT_EQ(hh_set_thread_count(before), HH_OK);
}

TEST(HostTuning, NumbersAreKeptAndRestoredAtOnce) {
    hh::World world;
    const std::vector<double> before = world.tuning_numbers();
    std::size_t described = 0;
    hh_tuning_info info = hh_default_tuning_info();
    for (std::size_t i = 0; hh_tuning_describe(i, &info) == HH_OK; ++i) {
        double values[3] = {};
        ASSERT_EQ(hh_world_get_tuning(world.get(), info.name, values, info.count), HH_OK);
        for (std::size_t j = 0; j < info.count; ++j) {
            ASSERT_LT(described, before.size());
            EXPECT_EQ(before[described++], values[j]) << info.name;
        }
    }
    EXPECT_EQ(described, before.size());
    ASSERT_TRUE(world.tune("hand.reach_m", 0.123));
    EXPECT_NE(world.tuning_numbers(), before);
    ASSERT_TRUE(world.set_tuning_numbers(before));
    EXPECT_EQ(world.tuning_numbers(), before);
    std::vector<double> wrong = before;
    wrong.back() = std::nan("");
    wrong.front() += 1e-6;
    EXPECT_EQ(world.set_tuning_numbers(wrong).result(), HH_ERROR_VALUE);
    EXPECT_EQ(world.set_tuning_numbers(std::span(before).first(5)).result(), HH_ERROR_VALUE);
    wrong = before;
    wrong.push_back(0.0);
    EXPECT_EQ(world.set_tuning_numbers(wrong).result(), HH_ERROR_VALUE);
    EXPECT_EQ(world.tuning_numbers(), before);
}

// What a step is given of a stream of samples: those up to its end, and one after it.
struct Stream {
    std::vector<hh::Sample> samples;
    std::size_t next = 0;

    std::span<const hh::Sample> once(double end_s) {
        const std::size_t first = next;
        while (next < samples.size() && (next == 0 || samples[next - 1].time_s <= end_s)) {
            ++next;
        }
        return std::span(samples).subspan(first, next - first);
    }
    std::span<const hh::Sample> window(double end_s) {
        const std::size_t first = next;
        while (next < samples.size() && samples[next].time_s <= end_s) {
            ++next;
        }
        const std::size_t last = std::min(next + 1, samples.size());
        return std::span(samples).subspan(first, last - first);
    }
};

// The same poses, whether the world keeps the sample after a step's end or is given it again; in
// the second case the state is that of step_frame with these windows.
RC_GTEST_PROP(HostSamples, MayBeGivenAgain, ()) {
    HostScene keeps;
    HostScene repeats;
    HostScene columns;
    for (HostScene* scene : {&keeps, &repeats, &columns}) {
        scene->add_wall();
    }
    Stream once;
    // Never within a microsecond of a step's end, where a kept sample would count as at the end.
    double t_s = 0.37e-3;
    for (int i = 0; i < 60; ++i) {
        t_s += 1e-3 * (*rc::gen::inRange(2, 25));
        hh::Sample sample = keeps.sample();
        sample.time_s = t_s;
        sample.hands[HH_RIGHT].position.x += 1e-3 * (*rc::gen::inRange(-3, 4));
        sample.grab[HH_RIGHT] = i > 10;
        once.samples.push_back(sample);
    }
    Stream again = once;
    Stream raw = once;
    for (int i = 0; i < 40; ++i) {
        const double end_s = keeps.world.time_s() + k_step_s;
        const hh_player_input first = hh::input(keeps.player, once.once(end_s));
        RC_ASSERT(static_cast<bool>(keeps.world.step(k_step_s, first)));
        hh_player_input second = hh::input(repeats.player, again.window(end_s));
        second.repeats_samples = true;
        RC_ASSERT(static_cast<bool>(repeats.world.step(k_step_s, second)));

        std::vector<TrackingSample> samples;
        for (const hh::Sample& sample : raw.window(end_s)) {
            TrackingSample& made = samples.emplace_back();
            made.t_s = sample.time_s;
            made.head_ps = from_host(sample.head);
            for (std::size_t side = 0; side < 2; ++side) {
                made.controllers[side].controller_ps = from_host(sample.hands[side]);
                made.controllers[side].grab = sample.grab[side] != 0;
            }
        }
        const HostColumns c = columns_of(columns.world.get());
        const PlayerInput input{entity_of(columns.player), samples, {}};
        StageStats stats;
        step_frame(c.world, c.caches, c.tuning, {k_step_s, {&input, 1}}, stats);

        const hh_player_pose a = *keeps.world.pose(keeps.player);
        const hh_player_pose b = *repeats.world.pose(repeats.player);
        RC_ASSERT(a.origin.position == b.origin.position);
        RC_ASSERT(a.hands[1].tracked.position == b.hands[1].tracked.position);
        RC_ASSERT(a.hands[1].grip == b.hands[1].grip);
        RC_ASSERT(repeats.world.hash() == columns.world.hash());
    }
}

// A host that computes a step's end in another way gives samples a little after it.
TEST(HostSamples, AreTakenToTheBitIfTheyAreGivenAgain) {
    for (const bool repeats : {false, true}) {
        HostScene scene;
        std::array<hh::Sample, 2> samples = {scene.sample(), scene.sample()};
        samples[0].time_s = 0.0;
        samples[1].time_s += 1e-9;
        samples[1].grab[HH_RIGHT] = true;
        hh_player_input input = hh::input(scene.player, samples);
        input.repeats_samples = repeats;
        ASSERT_TRUE(scene.world.step(k_step_s, input));
        EXPECT_EQ(scene.hand(HH_RIGHT).is_closed, !repeats);
    }
}

TEST(HostStats, CountHandsAndMomentum) {
    HostScene scene;
    scene.add_wall();
    scene.step(3);
    scene.closed[HH_RIGHT] = true;
    scene.step();
    const hh_world_stats stats = *scene.world.stats();
    EXPECT_EQ(stats.hands_closed, 1U);
    EXPECT_EQ(stats.hands_gripped, 1U);
    scene.hand_at[HH_RIGHT].z += 0.02;  // pulls the player, 80 kg, towards the wall
    scene.step();
    const hh_momentum momentum = scene.world.stats()->momentum;
    hh::Vec3 sum{};
    for (const hh::Vec3& one : momentum.linear_kgmps) {
        sum += one;
    }
    EXPECT_NEAR(hh::length(sum), 0.0, 1e-9);
    EXPECT_NEAR(momentum.linear_kgmps[HH_MOMENTUM_PLAYERS].z, -80.0 * 0.02 * 90.0, 1.0);
    EXPECT_EQ(scene.world.fallbacks().size(), static_cast<std::size_t>(Fallback::count));
    EXPECT_EQ(scene.world.stage_times_us().size(), static_cast<std::size_t>(Stage::count));
}

}  // namespace
}  // namespace handhold::host_queries_test
