// Worlds of many bodies: what is at rest costs nothing, and nobody notices that it is skipped.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_scale_test {
namespace {

using test::Random;

TEST(ScenarioScale, BodiesAtRestCostNothing) {
    Scenario s;
    s.fits_hands = false;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 place(5.0 + i % 15, i / 15 % 15, i / 225);
        if (i % 3 == 0) {
            s.add_wall("wall" + std::to_string(i), Vec3::Constant(0.1), place);
        } else {
            s.add_rock("rock" + std::to_string(i), 1.0, place);
        }
    }
    s.add_player_here();
    s.run(0.1);
    for (int frame = 0; frame < 20; ++frame) {
        s.step();
        // The player's head is looked at in every frame.
        EXPECT_LE(s.stats.active_bodies, 1U);
        EXPECT_LE(s.stats.bounds_updates, 2U);
        EXPECT_LE(s.stats.tree_queries, 10U);
        EXPECT_EQ(s.stats.narrowphase_calls, 0U);
    }
    // A host pushes one of them: only that one is looked at.
    const Entity rock = s.world.last_valid.owners()[50];
    s.world.body_velocity.at(rock).linear_mps = Vec3(0.0, 0.3, 0.0);
    const Vec3 start = s.body(rock).position;
    for (int frame = 0; frame < 20; ++frame) {
        s.step();
        EXPECT_LE(s.stats.active_bodies, 2U);
        EXPECT_LE(s.stats.narrowphase_calls, 2U);
    }
    EXPECT_NEAR((s.body(rock).position - start).y(), 0.3 * 20.0 / s.hz, 1e-9);
}

TEST(ScenarioScale, CostFollowsTheBodiesThatMoveNotAllBodies) {
    const auto work_of = [](int still) {
        Scenario s;
        s.fits_hands = false;
        for (int i = 0; i < still; ++i) {
            s.add_rock("still" + std::to_string(i), 1.0, Vec3(5.0 + i % 20, i / 20 % 20, i / 400));
        }
        for (int i = 0; i < 20; ++i) {
            const Entity rock = s.add_rock("moving" + std::to_string(i), 1.0, Vec3(-5.0, i, 0.0));
            s.world.body_velocity.at(rock).linear_mps = Vec3(-1.0, 0.0, 0.0);
        }
        s.add_player_here();
        s.run(0.3);
        return std::vector<std::uint64_t>{s.stats.active_bodies, s.stats.bounds_updates,
                                          s.stats.tree_queries, s.stats.narrowphase_calls};
    };
    EXPECT_EQ(work_of(50), work_of(5000));
}

// A world in which bodies of all kinds move, rest, collide, are changed by a host and come and go.
struct Yard {
    Scenario s;
    std::vector<Entity> rocks;

    explicit Yard(std::uint64_t seed) {
        s.fits_hands = false;
        Random random(seed);
        s.add_wall("floor", Vec3(3.0, 0.1, 3.0), Vec3(0.0, -0.5, 0.0));
        for (int i = 0; i < 40; ++i) {
            rocks.push_back(s.add_rock("rock" + std::to_string(i), 0.5 + 0.1 * (i % 7),
                                       random.vector(0.8) + Vec3(0.0, 0.8, -1.5)));
            if (i % 4 == 0) {
                s.world.body_velocity.at(rocks.back()) = {random.vector(1.0), random.vector(2.0)};
            }
        }
        for (int i = 0; i < 6; ++i) {
            Joint joint;
            joint.kind = JointKind::ball;
            joint.a = rocks[static_cast<std::size_t>(2 * i)];
            joint.b = rocks[static_cast<std::size_t>(2 * i + 1)];
            const Vec3 middle = 0.5 * (s.body(joint.a).position + s.body(joint.b).position);
            joint.frame_a_bs = inverse(s.body(joint.a)) * Pose{middle, Quat::Identity()};
            joint.frame_b_bs = inverse(s.body(joint.b)) * Pose{middle, Quat::Identity()};
            add_joint(s.world, {"joint" + std::to_string(i), joint});
        }
        const Entity mover = s.add_wall("mover", Vec3::Constant(0.2), Vec3(-1.5, 0.8, -1.5));
        s.set_motion(mover, Vec3(0.4, 0.0, 0.0), Vec3::Zero());
        s.script.hands[1] = [](double t_s) {
            return Pose{Vec3(0.3 * std::sin(3.0 * t_s), 1.0, -0.5), Quat::Identity()};
        };
        s.script.grabs[1] = [](double t_s) { return std::fmod(t_s, 0.7) < 0.5; };
        s.add_player_here();
    }
    // What a host may do between two frames.
    void meddle(Random& random) {
        const auto any = [&] {
            return rocks[static_cast<std::size_t>(random.between(0.0, 39.99))];
        };
        const double what = random.between(0.0, 1.0);
        const Entity rock = any();
        if (!s.world.body.contains(rock)) {
            return;
        }
        if (what < 0.1) {
            s.world.body_velocity.at(rock).linear_mps += random.vector(1.0);
        } else if (what < 0.2) {
            s.world.body_pose.at(rock).pose_ws.position += random.vector(0.3);
        } else if (what < 0.25) {
            s.world.body.at(rock).mass_kg = random.between(0.2, 3.0);
        } else if (what < 0.3) {
            s.world.body.at(rock).restitution = random.between(0.0, 1.0);
        } else if (what < 0.35) {
            s.tuning.phases.heavy_body_kg = random.between(0.4, 2.0);
        } else if (what < 0.38) {
            destroy(s.world, rock);
        } else if (what < 0.4) {
            s.world.body.at(rock).kind = BodyKind::fixed;
            s.world.body_velocity.at(rock) = {};
        } else if (what < 0.42 && !s.world.filter.contains(rock)) {
            s.world.filter.add(rock, {1U, 2U});
        } else if (what < 0.44) {
            s.world.last_valid.at(rock).pose_ws.position += random.vector(0.1);
        }
    }
};

// Caches only save work: with new ones in every frame, every bit of the state is the same.
TEST(ScenarioScale, SkippingBodiesAtRestChangesNoBit) {
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
        Yard warm(seed);
        Yard cold(seed);
        Random meddling_warm(seed + 100);
        Random meddling_cold(seed + 100);
        for (int frame = 0; frame < 250; ++frame) {
            warm.meddle(meddling_warm);
            cold.meddle(meddling_cold);
            cold.s.drop_caches();
            warm.s.step();
            cold.s.step();
            ASSERT_EQ(hash_state(warm.s.world), hash_state(cold.s.world))
                << "seed " << seed << " frame " << frame;
        }
    }
}

}  // namespace
}  // namespace handhold::scenario_scale_test
