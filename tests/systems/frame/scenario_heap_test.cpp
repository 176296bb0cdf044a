// Heaps and contradictions: bounded work, bounded overlap, bounded speed, whatever the input.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/shoved_heap.hpp"

namespace handhold::scenario_heap_test {
namespace {

using test::Random;

constexpr double k_half_m = 0.1;

double fastest_mps(const Scenario& s) {
    double fastest = 0.0;
    for (const BodyVelocity& velocity : s.world.body_velocity.elements()) {
        fastest = std::max(fastest, velocity.linear_mps.norm());
    }
    return fastest;
}

double kinetic_energy(const Scenario& s) {
    double energy = 0.0;
    for (std::size_t index = 0; index < s.world.body.size(); ++index) {
        const RigidBody& body = s.world.body.elements()[index];
        const Entity entity = s.world.body.owners()[index];
        const BodyVelocity& velocity = s.world.body_velocity.at(entity);
        if (body.kind == BodyKind::free) {
            const Quat& rotation = s.world.body_pose.at(entity).pose_ws.rotation;
            const Vec3 spin_bs = rotation.conjugate() * velocity.angular_radps;
            energy += 0.5 * body.mass_kg * velocity.linear_mps.squaredNorm() +
                      0.5 * spin_bs.dot(body.inertia_kgm2.cwiseProduct(spin_bs));
        }
    }
    return energy;
}

TEST(Heap, CratesShovedAgainstAWallOverlapByAtMostAMillimetreAndPushThePlayerBack) {
    for (const int side : {2, 3, 4}) {
        Scenario s;
        s.fits_hands = false;
        test::add_shoved_heap(side, s);
        std::uint64_t most_iterations = 0;
        s.run(1.0, [&] {
            ASSERT_LE(s.stats.residual_m, 1e-3) << side << " " << s.t_s();
            ASSERT_LE(s.stats.hand_error_m, 1e-5) << side << " " << s.t_s();
            most_iterations = std::max(most_iterations, s.stats.newton_iterations);
        });
        EXPECT_EQ(s.fallbacks(Fallback::solver_budget), 0U) << side;
        EXPECT_LE(most_iterations, 60U) << side;
        EXPECT_GT(s.origin().z(), 0.1) << side;
    }
}

// A crate in the right hand that is pushed into crates of random sizes and masses before a wall.
struct RandomShove {
    double hand_mps = 0.0;  // highest speed of the hand

    RandomShove(std::uint64_t seed, Scenario& s) {
        Random random(seed);
        s.fits_hands = false;
        s.frame_ws = random.pose(5.0);
        s.add_crate("held", random.between(0.5, 8.0), Vec3(0.3, 1.2 - k_half_m - 0.02, -0.1),
                    Vec3::Constant(k_half_m));
        const auto count = [&] { return 1 + static_cast<int>(random.between(0.0, 3.0)); };
        const int across = count();
        const int up = count();
        const int deep = count();
        const double jitter_m = random.between(0.0, 0.02);
        const double spacing_m = 2.0 * k_half_m + 2.0 * jitter_m + random.between(0.0, 0.02);
        const Vec3 first{0.3 - 0.5 * (across - 1) * spacing_m + random.between(-0.1, 0.1),
                         1.2 - 0.5 * (up - 1) * spacing_m + random.between(-0.1, 0.1), -0.45};
        for (int i = 0; i < across * up * deep; ++i) {
            const Vec3 place(i % across, i / across % up, -(i / (across * up)));
            const double mass_kg = random.between(1.0, 10.0);
            const Vec3 center = first + spacing_m * place + random.vector(jitter_m);
            s.add_crate("crate" + std::to_string(i), mass_kg, center,
                        Vec3::Constant(k_half_m) + random.vector(0.3 * jitter_m));
        }
        s.add_wall("wall", Vec3(3.0, 3.0, 0.1),
                   Vec3(0.3, 1.2, -0.45 - deep * spacing_m + k_half_m - 0.2));
        const double friction = random.between(0.0, 1.0);
        for (const Entity body : s.world.body.owners()) {
            s.world.body.at(body).friction = friction;
        }
        const double way_m = random.between(0.2, 0.8);
        const double duration_s = random.between(0.1, 0.6);
        const Vec3 direction = Vec3{random.between(-0.3, 0.3), random.between(-0.3, 0.3), -1.0};
        const Vec3 way = way_m * direction.normalized();
        s.script.grabs[1] = [](double) { return true; };
        s.script.hands[1] = [way, duration_s](double t_s) {
            return Pose{Vec3(0.3, 1.2, -0.02) + way * ease(t_s, 0.2, 0.2 + duration_s),
                        Quat::Identity()};
        };
        s.add_player_here();
        hand_mps = 1.5 * way_m / duration_s;
    }
};

// Some shoves still end in a contradiction. Of seeds 1 to 1000 (30 November), 40 left more than
// 0.1 mm at the hand, and 7 threw a crate at three times the hand's speed. Without corners that
// overhang the other body (add_deepest_at_end): 70 and 5.
TEST(Heap, NearlyAllRandomShovesKeepHandsExactAndThrowNothing) {
    constexpr int k_shoves = 160;
    constexpr double k_exact_m = 1e-4;
    constexpr double k_throw_ratio = 3.0;
    int inexact = 0;
    int thrown = 0;
    for (std::uint64_t seed = 1; seed <= k_shoves; ++seed) {
        Scenario s;
        const RandomShove shove(seed, s);
        double worst_hand_m = 0.0;
        double fastest_seen_mps = 0.0;
        s.run(1.2, [&] {
            worst_hand_m = std::max(worst_hand_m, s.stats.hand_error_m);
            fastest_seen_mps = std::max(fastest_seen_mps, fastest_mps(s));
        });
        inexact += worst_hand_m > k_exact_m ? 1 : 0;
        thrown += fastest_seen_mps > k_throw_ratio * shove.hand_mps ? 1 : 0;
    }
    EXPECT_LE(inexact, 10);  // 40 of 1000 predicts 6 with a deviation of 2.5
    EXPECT_LE(thrown, 1);    // of other 160: 3 with iterates of friction that did not converge
}

TEST(Heap, BodiesSpawnedInOnePlaceComeApartAtRest) {
    Scenario s;
    s.fits_hands = false;
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        s.add_crate("crate" + std::to_string(i), 5.0, Vec3(0.0, 1.0, -3.0) + random.vector(0.05),
                    Vec3::Constant(k_half_m));
    }
    s.add_player_here();
    s.run(1.0, [&] { ASSERT_LE(fastest_mps(s), 1e-6) << s.t_s(); });
    EXPECT_LE(s.stats.residual_m, 1e-4);
}

TEST(Heap, WallsThatCloseOnCratesAndOnThePlayerThrowNothing) {
    constexpr double k_fastest_mps = 10.0;
    for (const double speed_mps : {0.28, 0.3, 0.32}) {
        Scenario s;
        s.fits_hands = false;
        for (int i = 0; i < 27; ++i) {
            const Vec3 place(i % 3, i / 3 % 3, i / 9);
            s.add_crate("crate" + std::to_string(i), 5.0, Vec3(-0.25, 0.5, -1.5) + 0.25 * place,
                        Vec3::Constant(k_half_m));
        }
        for (const double side : {-1.0, 1.0}) {
            const Entity wall = s.add_wall(side < 0.0 ? "left" : "right", Vec3(0.1, 3.0, 3.0),
                                           Vec3(0.7 * side, 1.0, 0.0));
            s.set_motion(wall, Vec3(-speed_mps * side, 0.0, 0.0), Vec3::Zero());
        }
        s.add_player_here();
        double fastest_seen_mps = 0.0;
        s.run(3.0, [&] {
            fastest_seen_mps = std::max({fastest_seen_mps, fastest_mps(s), s.velocity().norm()});
            ASSERT_TRUE(s.origin().allFinite()) << s.t_s();
        });
        EXPECT_LE(fastest_seen_mps, k_fastest_mps) << speed_mps;
        RecordProperty("fastest at " + std::to_string(speed_mps), std::to_string(fastest_seen_mps));
    }
}

TEST(Heap, RingThatCannotCloseStaysBoundedInWorkAndSpeed) {
    Scenario s;
    constexpr int k_links = 7;
    std::vector<Entity> links;
    for (int i = 0; i < k_links; ++i) {
        const double angle = 2.0 * k_pi * i / k_links;
        links.push_back(s.add_crate("link" + std::to_string(i), 1.0,
                                    Vec3(std::cos(angle), 1.0 + std::sin(angle), -2.0),
                                    Vec3(0.1, 0.02, 0.02)));
    }
    for (int i = 0; i < k_links; ++i) {
        Joint joint;
        joint.kind = JointKind::ball;
        joint.a = links[static_cast<std::size_t>(i)];
        joint.b = links[static_cast<std::size_t>((i + 1) % k_links)];
        joint.frame_a_bs.position.x() = i == 0 ? 3.0 : 0.1;  // longer than all others together
        joint.frame_b_bs.position.x() = -0.1;
        add_joint(s.world, {"joint" + std::to_string(i), joint});
    }
    s.add_player_here();
    std::uint64_t most_iterations = 0;
    s.run(1.0, [&] {
        ASSERT_LE(fastest_mps(s), 10.0) << s.t_s();
        most_iterations = std::max(most_iterations, s.stats.newton_iterations);
    });
    EXPECT_LE(most_iterations, 400U);
}

// Fast impacts act on two lever arms (RowBlock::is_impact); 5e-6 of the energy was seen to be
// added.
TEST(Heap, RestitutionAndFrictionNeverAddEnergy) {
    constexpr double k_two_arms = 1e-5;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        Scenario s;
        s.fits_hands = false;
        for (int i = 0; i < 20; ++i) {
            const Vec3 center = Vec3(0.0, 2.0, -3.0) + random.vector(0.8);
            const std::string name = "body" + std::to_string(i);
            const double mass_kg = random.between(0.5, 5.0);
            const Entity body =
                i % 2 == 0 ? s.add_rock(name, mass_kg, center)
                           : s.add_crate(name, mass_kg, center,
                                         Vec3::Constant(0.02) + random.vector(0.01).cwiseAbs());
            s.world.body.at(body).restitution = 1.0;
            s.world.body.at(body).friction = random.between(0.0, 1.0);
            s.world.body_velocity.at(body) = {random.vector(4.0), random.vector(10.0)};
        }
        for (const double side : {-1.0, 1.0}) {
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 half_m = Vec3::Constant(1.4);
                half_m[axis] = 0.1;
                Vec3 center(0.0, 2.0, -3.0);
                center[axis] += side * 1.3;
                const Entity wall = s.add_wall(
                    "wall" + std::to_string(axis) + (side < 0.0 ? "-" : "+"), half_m, center);
                s.world.body.at(wall).restitution = 1.0;
                s.world.body.at(wall).friction = 0.5;
            }
        }
        s.add_player_here(Vec3(0.0, 0.0, 3.0));
        const double start = kinetic_energy(s);
        s.run(3.0, [&] {
            ASSERT_LE(kinetic_energy(s), start * (1.0 + k_two_arms)) << seed << " " << s.t_s();
        });
        EXPECT_GT(kinetic_energy(s), 0.05 * start) << seed;
    }
}

}  // namespace
}  // namespace handhold::scenario_heap_test
