// Players of every size: a world in which everything has `scale` times the size, with samples to
// match, behaves like the unscaled one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "engine/geometry/grip_mesh.hpp"
#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_scale_test {
namespace {

using test::distance_m;
using test::k_palm_ahead;
using test::k_step_s;
using test::Random;

constexpr hh::Vec3 k_lift_m{0.4, 1.2, -0.55};
constexpr hh::Vec3 k_wall_m{-0.5, 1.4, -0.6};
constexpr hh::Vec3 k_wall_half_m{0.4, 2.0, 0.05};
constexpr double k_ball_radius_m = 0.05;

// One player. A wall ahead of the left hand; ahead of the right one a lift or a ball of 2 kg.
struct Scene {
    double scale;
    hh::World world;
    hh::Player player{};
    hh::Body lift{};
    hh::Body ball{};

    Scene(double s, bool has_ball) : scale(s) {
        hh_player_def you = hh::player_def();
        you.scale = scale;
        player = *world.add(you);
        (void)world.use_wrists(player);
        // A number of the world, not of a player.
        const char* const bounces = "contact.restitution_speed_mps";
        (void)world.tune(bounces, scale * *world.tuning(bounces));
        add(HH_STATIC, *world.add_box(scale * k_wall_half_m), k_wall_m);
        if (has_ball) {
            ball = add(HH_DYNAMIC, *world.add_sphere(scale * k_ball_radius_m), {0.2, 1.3, -0.53});
        } else {
            lift = add(HH_KINEMATIC, *world.add_box(scale * hh::Vec3{0.3, 1.0, 0.05}), k_lift_m);
        }
    }
    hh::Body add(hh_body_kind kind, hh::Shape shape, const hh::Vec3& at) {
        hh_body_def def = hh::body_def();
        def.kind = kind;
        def.shape = shape;
        def.pose.position = scale * at;
        def.mass_kg = 2.0;
        return *world.add(def);
    }
    hh_player_pose pose() const {
        hh_player_pose out;
        EXPECT_EQ(hh_world_player_poses(world.get(), &player, 1, &out), HH_OK);
        return out;
    }
    // Velocity of the ball in the unscaled world.
    hh::Vec3 ball_mps() const {
        hh::Vec3 velocity{};
        EXPECT_EQ(hh_body_velocity(world.get(), ball, &velocity, nullptr), HH_OK);
        return velocity / scale;
    }
    // From the ball's surface to the wall, in the unscaled world.
    double ball_to_wall_m() const {
        const hh::Vec3 at = world.pose(ball)->position / scale - k_wall_m;
        const auto beyond = [](double x, double half) { return std::max(std::abs(x) - half, 0.0); };
        return hh::length({beyond(at.x, k_wall_half_m.x), beyond(at.y, k_wall_half_m.y),
                           beyond(at.z, k_wall_half_m.z)}) -
               k_ball_radius_m;
    }
};

// Where hands go, as sums of waves, and when they close: in most sessions alternately.
// If both grip, and the lift moves, they contradict each other.
struct Plan {
    explicit Plan(Random& random)
        : head(random.vector(0.05)),
          hands{random.vector(0.12), random.vector(0.12)},
          rate_hz(random.between(0.2, 0.8)),
          period_s(random.between(1.0, 2.0)),
          lift_mps(random.between(-0.3, 0.3)),
          has_ball(random.between(0.0, 1.0) < 0.5),
          shift(random.between(0.0, 1.0) < 0.6 ? 0.5 : 0.1) {}

    hh::Sample sample(double t_s, double scale) const {
        const double wave = std::sin(6.28 * rate_hz * t_s);
        const auto at = [&](const hh::Vec3& middle, const Vec3& sway) {
            return scale * (middle + wave * hh::Vec3{sway.x(), sway.y(), sway.z()});
        };
        hh::Sample made = hh::sample();
        made.time_s = t_s;
        made.head.position = at({0.0, 1.6, 0.0}, head);
        made.hands[0] = hh::pose_at(at({-0.25, 1.35, -0.45}, hands[0]), k_palm_ahead);
        made.hands[1] = hh::pose_at(at({0.2, 1.25, -0.45}, hands[1]), k_palm_ahead);
        for (std::size_t side = 0; side < 2; ++side) {
            const double phase = std::fmod(t_s / period_s + shift * static_cast<double>(side), 1.0);
            made.grab[side] = phase > 0.55;
        }
        return made;
    }

    Vec3 head;
    std::array<Vec3, 2> hands;
    double rate_hz;
    double period_s;
    double lift_mps;
    bool has_ball;
    double shift;  // delay of the right hand's grips, in periods
};

// Sums over all sessions.
struct Counts {
    int sessions = 0;
    std::size_t with_ball = 0;  // sessions
    int contradicting = 0;      // ended by hands that contradict each other
    std::size_t compared = 0;   // frames
    std::size_t surface = 0;    // frames of hands that grip a wall or lift
    std::size_t held = 0;       // frames of hands that hold the ball
    std::size_t thrown = 0;     // balls
};

// Scales of 0.1 to 20; sessions of 3 s in which hands grip, pull, carry and throw. A session ends
// before the ball meets the wall: distances at which contacts are looked for do not scale, so
// the frame of the impact may differ. It also ends where hands contradict each other: how the error
// is divided depends on the size.
void compare_session(Counts& counts) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-1.0, std::log10(20.0)));
    const Plan plan(random);
    Scene one(1.0, plan.has_ball);
    Scene other(scale, plan.has_ball);
    bool was_held = false;
    ++counts.sessions;
    counts.with_ball += plan.has_ball ? 1 : 0;
    for (int frame = 1; frame <= 270; ++frame) {
        const double t_s = frame * k_step_s;
        for (Scene* const scene : {&one, &other}) {
            if (!plan.has_ball) {
                const hh::Vec3 lift_m = k_lift_m + plan.lift_mps * t_s * hh::k_y;
                RC_ASSERT(static_cast<bool>(scene->world.move_kinematic(
                    scene->lift, hh::pose_at(scene->scale * lift_m, {0.0, 0.0, 0.0, 1.0}))));
            }
            const hh::Sample sample = plan.sample(t_s, scene->scale);
            RC_ASSERT(static_cast<bool>(
                scene->world.step(k_step_s, hh::input(scene->player, {&sample, 1}))));
        }
        const hh_player_pose a = one.pose();
        const hh_player_pose b = other.pose();
        constexpr double k_exact_m = 1e-4;
        const double error_m = std::max(a.hands[0].error_m, a.hands[1].error_m);
        const double other_error_m = std::max(b.hands[0].error_m, b.hands[1].error_m) / scale;
        if (std::max(error_m, other_error_m) > k_exact_m) {
            RC_ASSERT(std::min(error_m, other_error_m) > 0.1 * k_exact_m);
            ++counts.contradicting;
            return;
        }
        const bool is_held = a.hands[HH_RIGHT].grip == HH_GRIP_HELD;
        if (plan.has_ball && one.ball_to_wall_m() < 0.02) {
            return;
        }
        const auto apart_m = [scale](const hh::Vec3& p, const hh::Vec3& q) {
            return distance_m(p, q / scale);
        };
        constexpr double k_near_m = 1e-3;
        constexpr double k_near_mps = 5e-2;
        RC_ASSERT(apart_m(a.origin.position, b.origin.position) < k_near_m);
        RC_ASSERT(apart_m(a.head.position, b.head.position) < k_near_m);
        RC_ASSERT(apart_m(a.velocity_mps, b.velocity_mps) < k_near_mps);
        for (std::size_t side = 0; side < 2; ++side) {
            const hh_hand_state& p = a.hands[side];
            const hh_hand_state& q = b.hands[side];
            RC_ASSERT(p.grip == q.grip);
            RC_ASSERT(p.is_tracked == q.is_tracked);
            RC_ASSERT(apart_m(p.tracked.position, q.tracked.position) < k_near_m);
            RC_ASSERT(apart_m(p.anchor.position, q.anchor.position) < k_near_m);
            counts.surface += p.grip == HH_GRIP_SURFACE ? 1 : 0;
            counts.held += p.grip == HH_GRIP_HELD ? 1 : 0;
        }
        if (was_held && !is_held) {
            RC_ASSERT(distance_m(one.ball_mps(), other.ball_mps()) < k_near_mps);
            ++counts.thrown;
        }
        was_held = is_held;
        ++counts.compared;
    }
}

TEST(HostScale, AScaledWorldBehavesLikeTheUnscaledOne) {
    Counts counts;
    EXPECT_TRUE(rc::check([&counts] { compare_session(counts); }));
    const auto sessions = static_cast<std::size_t>(counts.sessions);
    EXPECT_GT(counts.contradicting, 0);
    EXPECT_GT(counts.compared, 180 * sessions);
    EXPECT_GT(counts.surface, 60 * sessions);
    EXPECT_GT(counts.held, 30 * counts.with_ball);
    EXPECT_GT(2 * counts.thrown, counts.with_ball);
}

// A hand of another size is shown like one of the usual size. The detail of the surface does not
// scale, so joints divided by the scale agree only as well as two meshes that deviate from it.
RC_GTEST_PROP(HostScale, HandsAreShownInTheirPlayersSize, ()) {
    constexpr GripMeshSettings k_mesh{};
    constexpr double k_detail_m = k_mesh.search.deviation_m + k_mesh.shape_tolerance_m;
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-0.7, 1.0));
    Scene one(1.0, false);
    Scene other(scale, false);
    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> a{};
    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> b{};
    const bool closes = *rc::gen::arbitrary<bool>();
    for (Scene* const scene : {&one, &other}) {
        for (int frame = 1; frame <= 90; ++frame) {
            const double t_s = frame / 90.0;
            hh::Sample sample = hh::sample();
            sample.time_s = t_s;
            sample.head.position = scene->scale * hh::Vec3{0.0, 1.6, 0.0};
            sample.hands[0] = hh::pose_at(scene->scale * hh::Vec3{-0.2, 1.35, -0.53}, k_palm_ahead);
            sample.hands[1] = hh::pose_at(scene->scale * hh::Vec3{0.3, 1.0, -0.2}, k_palm_ahead);
            sample.grab[0] = closes && t_s > 0.2;
            RC_ASSERT(static_cast<bool>(
                scene->world.step(1.0 / 90.0, hh::input(scene->player, {&sample, 1}))));
        }
        RC_ASSERT(hh_player_hand_joints(scene->world.get(), scene->player, HH_LEFT, HH_SPACE_WORLD,
                                        scene == &one ? a.data() : b.data()) == HH_OK);
    }
    RC_ASSERT((one.pose().hands[0].grip != HH_GRIP_NONE) == closes);
    for (std::size_t i = 0; i < a.size(); ++i) {
        RC_ASSERT(a[i].is_valid && b[i].is_valid && a[i].radius_m > 0.0);
        const double apart_m = distance_m(a[i].pose.position, b[i].pose.position / scale);
        RC_ASSERT(apart_m < (closes ? k_detail_m : 1e-9));
        RC_ASSERT(std::abs(a[i].radius_m - b[i].radius_m / scale) < 1e-12);
    }
}

TEST(HostScale, ScalesAndMeasuresAreTakenInTheRangeOfTheHeader) {
    hh::World world;
    for (const double scale : {0.01, 0.1, 1.0, 20.0, 100.0}) {
        hh_player_def def = hh::player_def();
        def.scale = scale;
        const auto player = world.add(def);
        ASSERT_TRUE(player) << scale;
        hh_measures measures;
        ASSERT_EQ(hh_player_measures(world.get(), *player, &measures), HH_OK);
        EXPECT_DOUBLE_EQ(measures.eye_height_m, scale * def.measures.eye_height_m);
        EXPECT_EQ(hh_player_set_measures(world.get(), *player, &measures), HH_OK);
        measures.forearm_m = scale * 5.1;
        EXPECT_EQ(hh_player_set_measures(world.get(), *player, &measures), HH_ERROR_VALUE);
        double radius_m = 0.0;
        ASSERT_EQ(hh_player_head(world.get(), *player, nullptr, &radius_m, nullptr), HH_OK);
        EXPECT_DOUBLE_EQ(radius_m, scale * *world.tuning("head.radius_m"));
    }
    for (const double scale : {0.0, 0.009, 101.0, -1.0, std::nan("")}) {
        hh_player_def def = hh::player_def();
        def.scale = scale;
        EXPECT_EQ(world.add(def).status().result(), HH_ERROR_VALUE) << scale;
    }
}

// A large and a small player in one world do not disturb each other.
TEST(HostScale, PlayersOfSeveralSizesShareAWorld) {
    hh::World world;
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({20.0, 20.0, 0.1});
    wall.pose.position = {0.0, 0.0, -0.1};
    (void)*world.add(wall);
    std::vector<hh::Player> players;
    const std::vector<double> scales = {0.2, 1.0, 5.0};
    for (std::size_t i = 0; i < scales.size(); ++i) {
        hh_player_def def = hh::player_def();
        def.scale = scales[i];
        def.origin.position = {6.0 * static_cast<double>(i), 0.0, 0.6 * scales[i]};
        players.push_back(*world.add(def));
        ASSERT_TRUE(world.use_wrists(players.back()));
    }
    for (int frame = 1; frame <= 60; ++frame) {
        std::vector<hh::Sample> samples;
        for (const double scale : scales) {
            hh::Sample sample = hh::sample();
            sample.time_s = frame / 90.0;
            sample.head.position = scale * hh::Vec3{0.0, 1.6, 0.0};
            sample.hands[0] = hh::pose_at(scale * hh::Vec3{-0.2, 1.4, -0.53}, k_palm_ahead);
            sample.hands[1] = hh::pose_at(scale * hh::Vec3{0.2, 1.4, -0.53}, k_palm_ahead);
            sample.grab[0] = sample.grab[1] = frame > 20;
            samples.push_back(sample);
        }
        std::vector<hh_player_input> inputs;
        for (std::size_t i = 0; i < players.size(); ++i) {
            inputs.push_back(hh::input(players[i], {&samples[i], 1}));
        }
        ASSERT_EQ(hh_world_step(world.get(), 1.0 / 90.0, inputs.data(), inputs.size()), HH_OK);
    }
    for (std::size_t i = 0; i < players.size(); ++i) {
        for (const hh_side side : {HH_LEFT, HH_RIGHT}) {
            EXPECT_EQ(world.hand(players[i], side)->grip, HH_GRIP_SURFACE) << scales[i];
        }
        std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> joints{};
        ASSERT_EQ(
            hh_player_hand_joints(world.get(), players[i], HH_RIGHT, HH_SPACE_WORLD, joints.data()),
            HH_OK);
        const double hand_m = distance_m(joints[15].pose.position, joints[1].pose.position);
        EXPECT_GT(hand_m, 0.12 * scales[i]);
        EXPECT_LT(hand_m, 0.2 * scales[i]);
    }
}

}  // namespace
}  // namespace handhold::host_scale_test
