// Players of every size: a world in which everything has `scale` times the size, with samples to
// match, behaves like the unscaled one.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"

namespace handhold::host_scale_test {
namespace {

using test::Random;

constexpr hh::Quat k_palm_ahead{0.7071067811865476, 0.0, 0.0, 0.7071067811865476};

hh::Vec3 times(double scale, const hh::Vec3& v) { return {scale * v.x, scale * v.y, scale * v.z}; }
double length(const hh::Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

// A wall ahead, a ball of 2 kg in reach, a lift on the right, and one player.
struct Scene {
    double scale;
    hh::World world;
    hh::Player player{};
    hh::Body ball{};
    hh::Body lift{};
    hh::Vec3 lift_at;

    explicit Scene(double s) : scale(s), lift_at(times(s, {0.4, 1.2, -0.55})) {
        hh_player_def you = hh::player_def();
        you.scale = scale;
        player = *world.add(you);
        (void)world.use_wrists(player);
        // A number of the world, not of a player.
        const char* const bounces = "contact.restitution_speed_mps";
        (void)world.tune(bounces, scale * *world.tuning(bounces));
        add(HH_STATIC, *world.add_box(times(scale, {0.3, 2.0, 0.05})), {-0.2, 1.4, -0.6}, 0.0);
        ball = add(HH_DYNAMIC, *world.add_sphere(scale * 0.05), {0.05, 1.2, -0.4}, 2.0);
        lift = add(HH_KINEMATIC, *world.add_box(times(scale, {0.2, 0.5, 0.05})), {0.4, 1.2, -0.6},
                   0.0);
    }
    hh::Body add(hh_body_kind kind, hh::Shape shape, const hh::Vec3& at, double mass_kg) {
        hh_body_def def = hh::body_def();
        def.kind = kind;
        def.shape = shape;
        def.pose.position = times(scale, at);
        def.mass_kg = kind == HH_DYNAMIC ? mass_kg : 1.0;
        return *world.add(def);
    }
    hh_player_pose pose() const {
        hh_player_pose out;
        EXPECT_EQ(hh_world_player_poses(world.get(), &player, 1, &out), HH_OK);
        return out;
    }
};

// Where a hand goes, as a sum of waves, and when it is closed.
struct Plan {
    explicit Plan(Random& random)
        : head(random.vector(0.05)),
          hands{random.vector(0.12), random.vector(0.12)},
          rate_hz(random.between(0.2, 0.8)),
          period_s(random.between(0.5, 1.5)),
          lift_mps(random.between(-0.3, 0.3)) {}

    hh::Sample sample(double t_s, double scale) const {
        const double wave = std::sin(6.28 * rate_hz * t_s);
        const auto at = [&](const hh::Vec3& middle, const Vec3& sway) {
            return times(scale, {middle.x + wave * sway.x(), middle.y + wave * sway.y(),
                                 middle.z + wave * sway.z()});
        };
        hh::Sample made = hh::sample();
        made.time_s = t_s;
        made.head.position = at({0.0, 1.6, 0.0}, head);
        made.hands[0] = hh::pose_at(at({-0.2, 1.35, -0.5}, hands[0]), k_palm_ahead);
        made.hands[1] = hh::pose_at(at({0.2, 1.25, -0.45}, hands[1]), k_palm_ahead);
        for (std::size_t side = 0; side < 2; ++side) {
            const double phase = std::fmod(t_s + 0.3 * static_cast<double>(side), period_s);
            made.grab[side] = phase > 0.3 * period_s;
        }
        return made;
    }

    Vec3 head;
    std::array<Vec3, 2> hands;
    double rate_hz;
    double period_s;
    double lift_mps;
};

// Scales of 0.1 to 20; sessions of 3 s in which both hands grip, pull, carry and throw. Impacts of
// the ball are not compared: distances at which contacts are looked for do not scale, so the frame
// of an impact and a velocity in it may differ. Sessions end where hands contradict each other, as
// when a held ball is jammed against a wall: how the error is divided depends on the size.
RC_GTEST_PROP(HostScale, AScaledWorldBehavesLikeTheUnscaledOne, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-1.0, std::log10(20.0)));
    const Plan plan(random);
    Scene one(1.0);
    Scene other(scale);
    const double dt_s = 1.0 / 90.0;
    std::size_t grips = 0;
    for (int frame = 1; frame <= 270; ++frame) {
        const double t_s = frame * dt_s;
        for (Scene* const scene : {&one, &other}) {
            scene->lift_at.y += scene->scale * plan.lift_mps * dt_s;
            RC_ASSERT(static_cast<bool>(scene->world.move_kinematic(
                scene->lift, hh::pose_at(scene->lift_at, {0.0, 0.0, 0.0, 1.0}))));
            const hh::Sample sample = plan.sample(t_s, scene->scale);
            RC_ASSERT(
                static_cast<bool>(scene->world.step(dt_s, hh::input(scene->player, {&sample, 1}))));
        }
        const hh_player_pose a = one.pose();
        const hh_player_pose b = other.pose();
        const auto apart_m = [scale](const hh::Vec3& p, const hh::Vec3& q) {
            return length({p.x - q.x / scale, p.y - q.y / scale, p.z - q.z / scale});
        };
        constexpr double k_exact_m = 1e-4;
        if (std::max(a.hands[0].error_m, a.hands[1].error_m) > k_exact_m) {
            return;
        }
        constexpr double k_near_m = 1e-3;
        constexpr double k_near_mps = 5e-2;
        RC_ASSERT(apart_m(a.origin.position, b.origin.position) < k_near_m);
        RC_ASSERT(apart_m(a.head.position, b.head.position) < k_near_m);
        RC_ASSERT(apart_m(a.velocity_mps, b.velocity_mps) < k_near_mps);
        for (std::size_t side = 0; side < 2; ++side) {
            const hh_hand_state& p = a.hands[side];
            const hh_hand_state& q = b.hands[side];
            grips += p.grip != HH_GRIP_NONE ? 1 : 0;
            RC_ASSERT(p.grip == q.grip);
            RC_ASSERT(p.is_tracked == q.is_tracked);
            RC_ASSERT(apart_m(p.tracked.position, q.tracked.position) < k_near_m);
            RC_ASSERT(apart_m(p.anchor.position, q.anchor.position) < k_near_m);
        }
    }
    RC_TAG(grips > 0);
}

// A hand of another size is shown like one of the usual size. The detail of the surface does not
// scale, so joints divided by the scale agree within a few millimetres only.
RC_GTEST_PROP(HostScale, HandsAreShownInTheirPlayersSize, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-0.7, 1.0));
    Scene one(1.0);
    Scene other(scale);
    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> a{};
    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> b{};
    const bool closes = *rc::gen::arbitrary<bool>();
    for (Scene* const scene : {&one, &other}) {
        for (int frame = 1; frame <= 90; ++frame) {
            const double t_s = frame / 90.0;
            hh::Sample sample = hh::sample();
            sample.time_s = t_s;
            sample.head.position = times(scene->scale, {0.0, 1.6, 0.0});
            sample.hands[0] = hh::pose_at(times(scene->scale, {-0.2, 1.35, -0.53}), k_palm_ahead);
            sample.hands[1] = hh::pose_at(times(scene->scale, {0.3, 1.0, -0.2}), k_palm_ahead);
            sample.grab[0] = closes && t_s > 0.2;
            RC_ASSERT(static_cast<bool>(
                scene->world.step(1.0 / 90.0, hh::input(scene->player, {&sample, 1}))));
        }
        RC_ASSERT(hh_player_hand_joints(scene->world.get(), scene->player, HH_LEFT, HH_SPACE_WORLD,
                                        scene == &one ? a.data() : b.data()) == HH_OK);
    }
    RC_ASSERT((one.pose().hands[0].grip != HH_GRIP_NONE) == closes);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const hh::Vec3& p = a[i].pose.position;
        const hh::Vec3& q = b[i].pose.position;
        const double apart_m = length({p.x - q.x / scale, p.y - q.y / scale, p.z - q.z / scale});
        RC_ASSERT(apart_m < (closes ? 4e-3 : 1e-9));
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
            sample.head.position = times(scale, {0.0, 1.6, 0.0});
            sample.hands[0] = hh::pose_at(times(scale, {-0.2, 1.4, -0.53}), k_palm_ahead);
            sample.hands[1] = hh::pose_at(times(scale, {0.2, 1.4, -0.53}), k_palm_ahead);
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
        const hh::Vec3 wrist = joints[1].pose.position;
        const hh::Vec3 tip = joints[15].pose.position;
        const double hand_m = length({tip.x - wrist.x, tip.y - wrist.y, tip.z - wrist.z});
        EXPECT_GT(hand_m, 0.12 * scales[i]);
        EXPECT_LT(hand_m, 0.2 * scales[i]);
    }
}

}  // namespace
}  // namespace handhold::host_scale_test
