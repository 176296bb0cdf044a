// The distance grab through whole frames: two masses connected by a bounded force, in closed form.
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_pull_test {
namespace {

constexpr double k_close_s = 0.1;
constexpr double k_rock_kg = 2.0;
constexpr double k_player_kg = 80.0;

// The right palm faces a rock floating `below_m` under it, and closes at 0.1 s.
class FarRock {
  public:
    Scenario s;
    Entity rock;
    double open_s = 1e9;
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> counted{};

    explicit FarRock(double mass_kg = k_rock_kg, double below_m = 2.0, double reach_m = 3.0) {
        s.tuning.pull.reach_m = reach_m;
        s.tuning.locomotion.drift_drag_per_s = 0.0;
        rock = s.add_rock("rock", mass_kg, palm() - Vec3(0.0, below_m, 0.0));
        s.script.grabs[1] = [this](double t) { return t > k_close_s && t < open_s; };
    }
    Vec3 palm() const { return s.script.hands[1](0.0).position + s.tuning.hand.palm_center_m; }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        s.run(seconds, [&] {
            for (std::size_t i = 0; i < counted.size(); ++i) {
                counted[i] += s.stats.fallbacks[i];
            }
            after_frame();
        });
    }
    std::uint64_t count(Fallback reason) const { return counted[static_cast<std::size_t>(reason)]; }
    bool pulls() const { return s.world.hand_pull.contains(s.player.hands[1]); }
    Vec3 momentum() const {
        return k_player_kg * s.velocity() + s.world.body.at(rock).mass_kg * s.body_velocity(rock);
    }
};

TEST(Pull, IsOffByDefault) {
    EXPECT_EQ(Tuning{}.pull.reach_m, 0.0);
    FarRock scene(k_rock_kg, 2.0, 0.0);
    scene.s.add_player_here();
    const Vec3 place = scene.s.body(scene.rock).position;
    scene.run(1.0);
    EXPECT_EQ(scene.s.body(scene.rock).position, place);
    EXPECT_EQ(scene.s.velocity(), Vec3::Zero());
    EXPECT_EQ(scene.count(Fallback::grab_no_surface), 1U);
    EXPECT_FALSE(scene.pulls());
}

TEST(Pull, NeverPullsWhatTheHandMayNotGripAlone) {
    for (const GrabRule& rule : {GrabRule{.right = false}, GrabRule{.two_hands = true}}) {
        FarRock scene;
        scene.s.add_player_here();
        scene.s.world.grab_rule.add(scene.rock, rule);
        scene.run(1.0);
        EXPECT_EQ(scene.s.velocity(), Vec3::Zero());
        EXPECT_EQ(scene.count(Fallback::grab_refused_by_rule), 1U);
        EXPECT_FALSE(scene.pulls());
    }
}

TEST(Pull, AcceleratesByTheForceAndConservesMomentum) {
    FarRock scene;
    scene.s.add_player_here();
    scene.run(k_close_s);
    int frames = 0;
    scene.run(0.4, [&] {
        if (!scene.pulls()) {
            return;
        }
        ++frames;
        EXPECT_LT(scene.momentum().norm(), 1e-9) << "at " << scene.s.t_s();
        // Until the speed limit, every frame applies the full force.
        const double full_mps = frames * scene.s.tuning.pull.force_n / scene.s.hz / k_rock_kg;
        if (full_mps < 0.9 * scene.s.tuning.pull.speed_mps) {
            EXPECT_NEAR(scene.s.body_velocity(scene.rock).y(), full_mps, 1e-9) << frames;
        }
    });
    EXPECT_GT(frames, 20);
    const double closing_mps = scene.s.body_velocity(scene.rock).y() - scene.s.velocity().y();
    EXPECT_NEAR(closing_mps, scene.s.tuning.pull.speed_mps, 1e-6);
}

TEST(Pull, HandGripsTheBodyOnceItsSurfaceReachesThePalm) {
    FarRock scene;
    scene.s.add_player_here();
    double max_step_m = 0.0;
    Vec3 before = scene.s.body(scene.rock).position;
    scene.run(2.0, [&] {
        max_step_m = std::max(max_step_m, (scene.s.body(scene.rock).position - before).norm());
        before = scene.s.body(scene.rock).position;
    });
    const Grab& grab = scene.s.grab(HandSide::right);
    EXPECT_EQ(grab.kind, GripKind::held);
    EXPECT_EQ(grab.body, scene.rock);
    EXPECT_FALSE(scene.pulls());
    EXPECT_LT(grab.error_m, 1e-5);
    // It never moved farther in a frame than its speed allows: no teleport.
    EXPECT_LE(max_step_m, 1.01 * scene.s.tuning.pull.speed_mps / scene.s.hz);
    const Vec3 palm_ws = scene.s.origin() + scene.palm();
    const double gap_m = (scene.s.body(scene.rock).position - palm_ws).norm() - 0.08;
    EXPECT_LT(gap_m, 0.02 + 1e-6);
    EXPECT_GT(gap_m, -scene.s.tuning.hand.ray_back_m);
    EXPECT_EQ(scene.count(Fallback::pull_lost), 0U);
}

// A ring of twelve rods that faces the palm; the palm's ray hits one rod, and the ring's centre is
// empty.
ShapeId add_ring(ShapeLibrary& shapes, double radius_m) {
    constexpr int k_rods = 12;
    constexpr double k_thick_m = 0.015;
    const ShapeId rod = shapes.add_capsule(k_thick_m, k_pi * radius_m / k_rods);
    std::vector<CompoundChild> rods;
    for (int i = 0; i < k_rods; ++i) {
        const Quat around = rotation_about(Vec3::UnitY(), 2.0 * k_pi * i / k_rods);
        const Quat along = rotation_about(Vec3::UnitX(), k_half_pi);  // capsules stand on Y
        rods.push_back({rod, {around * Vec3(radius_m, 0.0, 0.0), around * along}, 1.0});
    }
    return shapes.add_compound(rods);
}

TEST(Pull, RingIsGrippedByItsRim) {
    for (const double radius_m : {0.12, 0.3}) {
        FarRock scene;
        Scenario& s = scene.s;
        destroy(s.world, scene.rock);
        const ShapeId shape = add_ring(s.shapes, radius_m);
        const Vec3 center = scene.palm() - Vec3(radius_m, 1.5, 0.0);
        scene.rock =
            s.add("ring", {BodyKind::free, 1.0, solid_inertia(s.shapes.at(shape), 1.0), 0.0}, shape,
                  {center, Quat::Identity()});
        s.add_player_here();
        scene.run(3.0);
        EXPECT_EQ(s.grab(HandSide::right).kind, GripKind::held) << radius_m;
        EXPECT_EQ(s.grab(HandSide::right).body, scene.rock) << radius_m;
    }
}

TEST(Pull, OpeningTheHandLeavesTheBodyItsVelocity) {
    FarRock scene;
    scene.open_s = 0.5;
    scene.s.add_player_here();
    scene.run(0.6);
    EXPECT_FALSE(scene.pulls());
    const Vec3 velocity = scene.s.body_velocity(scene.rock);
    EXPECT_GT(velocity.y(), 1.0);
    scene.run(0.1);
    EXPECT_EQ(scene.s.body_velocity(scene.rock), velocity);
    EXPECT_EQ(scene.s.grab(HandSide::right).kind, GripKind::none);
}

TEST(Pull, TooHeavyFixedAndHeldBodiesAreRefusedAndCounted) {
    FarRock heavy(20.1);
    heavy.s.add_player_here();
    heavy.run(0.5);
    EXPECT_EQ(heavy.count(Fallback::pull_refused_heavy), 1U);
    EXPECT_EQ(heavy.s.body_velocity(heavy.rock), Vec3::Zero());

    FarRock fixed;
    fixed.s.world.body.at(fixed.rock).kind = BodyKind::fixed;
    fixed.s.add_player_here();
    fixed.run(0.5);
    EXPECT_EQ(fixed.count(Fallback::pull_refused_fixed), 1U);

    FarRock held;
    const Entity beam =
        held.s.add_crate("beam", 3.0, held.palm() - Vec3(0.3, 0.8, 0.0), Vec3(0.4, 0.03, 0.03));
    held.s.script.hands[0] = [&](double) {
        return Pose{hand_for_palm(held.s, held.palm() - Vec3(0.6, 0.75, 0.0)), Quat::Identity()};
    };
    held.s.script.grabs[0] = [](double t) { return t > 0.05; };
    held.s.add_player_here();
    held.run(0.5);
    ASSERT_EQ(held.s.grab(HandSide::left).body, beam);
    EXPECT_EQ(held.count(Fallback::pull_refused_held), 1U);
    EXPECT_FALSE(held.pulls());
}

TEST(Pull, NothingBeyondTheReachIsPulled) {
    FarRock scene(k_rock_kg, 3.3);
    scene.s.add_player_here();
    scene.run(0.5);
    EXPECT_FALSE(scene.pulls());
    EXPECT_EQ(scene.s.body_velocity(scene.rock), Vec3::Zero());
}

TEST(Pull, EndsAndIsCountedIfBodyOrTrackingIsLost) {
    FarRock gone;
    gone.s.add_player_here();
    gone.run(0.3);
    ASSERT_TRUE(gone.pulls());
    destroy(gone.s.world, gone.rock);
    gone.run(0.1);
    EXPECT_FALSE(gone.pulls());
    EXPECT_EQ(gone.count(Fallback::pull_lost), 1U);

    FarRock lost;
    const Pose there = lost.s.script.hands[1](0.0);
    lost.s.script.hands[1] = [there](double t) {
        Pose pose = there;
        if (t > 0.3) {
            pose.position.x() = std::numeric_limits<double>::quiet_NaN();
        }
        return pose;
    };
    lost.s.add_player_here();
    lost.run(1.0);
    EXPECT_FALSE(lost.pulls());
    EXPECT_EQ(lost.count(Fallback::pull_lost), 1U);
    EXPECT_EQ(lost.s.grab(HandSide::right).kind, GripKind::none);
}

// Changes by the host end the pull: no impulse acts on a body that cannot move or has no mass.
TEST(Pull, EndsAndIsCountedIfTheBodyBecomesImmovable) {
    FarRock turned_fixed;
    turned_fixed.s.add_player_here();
    turned_fixed.run(0.3);
    ASSERT_TRUE(turned_fixed.pulls());
    RigidBody& body = turned_fixed.s.world.body.at(turned_fixed.rock);
    body.kind = BodyKind::fixed;
    body.mass_kg = 0.0;
    const Vec3 player_mps = turned_fixed.s.velocity();
    turned_fixed.run(0.2);
    EXPECT_FALSE(turned_fixed.pulls());
    EXPECT_EQ(turned_fixed.count(Fallback::pull_lost), 1U);
    EXPECT_TRUE(turned_fixed.s.body_velocity(turned_fixed.rock).allFinite());
    EXPECT_LT((turned_fixed.s.velocity() - player_mps).norm(), 1e-9);

    FarRock grown_heavy;
    grown_heavy.s.add_player_here();
    grown_heavy.run(0.3);
    ASSERT_TRUE(grown_heavy.pulls());
    grown_heavy.s.world.body.at(grown_heavy.rock).mass_kg = 20.1;
    grown_heavy.run(0.1);
    EXPECT_FALSE(grown_heavy.pulls());
    EXPECT_EQ(grown_heavy.count(Fallback::pull_lost), 1U);
}

// A hand that resumes tracking elsewhere must not pull the body there.
TEST(Pull, EndsAndIsCountedIfTheHandJumps) {
    FarRock scene;
    const Pose there = scene.s.script.hands[1](0.0);
    scene.s.script.hands[1] = [there](double t) {
        Pose pose = there;
        if (t > 0.3) {
            pose.position.x() += 2.0;
        }
        return pose;
    };
    scene.s.add_player_here();
    scene.run(0.29);
    ASSERT_TRUE(scene.pulls());
    scene.run(0.3);
    EXPECT_FALSE(scene.pulls());
    EXPECT_EQ(scene.count(Fallback::pull_lost), 1U);
    EXPECT_NEAR(scene.s.body_velocity(scene.rock).x(), 0.0, 1e-9);
}

TEST(Pull, OnlyOneOfTwoHandsPullsABody) {
    FarRock scene;
    // Both palms face it, 10 cm apart.
    scene.s.script.hands[0] = [&](double) {
        return Pose{hand_for_palm(scene.s, scene.palm() + Vec3(0.04, 0.1, 0.0)), Quat::Identity()};
    };
    scene.s.script.grabs[0] = [](double t) { return t > 0.2; };
    scene.s.add_player_here();
    scene.run(0.5);
    EXPECT_TRUE(scene.pulls());
    EXPECT_FALSE(scene.s.world.hand_pull.contains(scene.s.player.hands[0]));
    EXPECT_EQ(scene.count(Fallback::pull_refused_held), 1U);
    EXPECT_LT(scene.momentum().norm(), 1e-9);
}

TEST(Pull, PlayerHoldingAWallIsNotMoved) {
    FarRock scene;
    scene.s.add_wall("wall", Vec3(0.05, 0.5, 0.5), Vec3(-0.42, 1.2, 0.3));
    scene.s.script.grabs[0] = [](double t) { return t > 0.02; };
    scene.s.add_player_here();
    scene.run(2.0);
    ASSERT_EQ(scene.s.grab(HandSide::left).kind, GripKind::surface);
    EXPECT_EQ(scene.s.grab(HandSide::right).body, scene.rock);
    EXPECT_LT(scene.s.origin().norm(), 1e-6);
}

TEST(Pull, DroppingCachesChangesNoBit) {
    std::array<std::uint64_t, 2> hashes{};
    for (const bool drops : {false, true}) {
        FarRock scene;
        scene.s.add_player_here();
        scene.run(0.4);
        EXPECT_TRUE(scene.pulls());
        if (drops) {
            scene.s.drop_caches();
        }
        scene.run(1.5);
        EXPECT_EQ(scene.s.grab(HandSide::right).body, scene.rock);
        hashes[drops ? 1 : 0] = hash_state(scene.s.world);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace handhold::scenario_pull_test
