// Worlds that ask for more than a frame can give: work, movement and speed stay bounded, and what
// is near does not suffer.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_budget_test {
namespace {

using test::Random;

constexpr double k_half_m = 0.1;

// Crates whose centres all lie within a few centimetres, far from the player.
std::vector<Entity> add_pile(int count, Scenario& s) {
    Random random(7);
    std::vector<Entity> crates;
    for (int i = 0; i < count; ++i) {
        const Vec3 place = Vec3(8.0, 0.0, 0.0) + random.vector(0.05);
        crates.push_back(
            s.add_crate("pile" + std::to_string(i), 1.0, place, Vec3::Constant(k_half_m)));
        s.world.body_pose.at(crates.back()).pose_ws.rotation = random.rotation();
        s.world.last_valid.at(crates.back()).pose_ws = s.world.body_pose.at(crates.back()).pose_ws;
    }
    return crates;
}

double fastest_mps(const Scenario& s, const std::vector<Entity>& bodies) {
    double fastest = 0.0;
    for (const Entity body : bodies) {
        fastest = std::max(fastest, s.body_velocity(body).norm());
    }
    return fastest;
}

double spread_m(const Scenario& s, const std::vector<Entity>& bodies) {
    double spread = 0.0;
    for (const Entity body : bodies) {
        spread = std::max(spread, (s.body(body).position - Vec3(8.0, 0.0, 0.0)).norm());
    }
    return spread;
}

TEST(ScenarioBudget, APileIsTakenApartOverManyFramesWithoutSpeed) {
    Scenario s;
    s.fits_hands = false;
    const std::vector<Entity> pile = add_pile(150, s);
    s.add_player_here();
    std::uint64_t budget = 0;
    std::uint64_t deferred = 0;
    std::uint64_t narrowphase_calls = 0;
    double longest_m = 0.0;
    for (int frame = 0; frame < 500; ++frame) {
        std::vector<Vec3> before;
        for (const Entity crate : pile) {
            before.push_back(s.body(crate).position);
        }
        s.step();
        budget += s.fallbacks(Fallback::solver_budget);
        deferred += s.fallbacks(Fallback::pairs_deferred);
        narrowphase_calls = std::max(narrowphase_calls, s.stats.narrowphase_calls);
        EXPECT_LE(fastest_mps(s, pile), 1e-3) << "depenetration must not become velocity";
        for (std::size_t i = 0; i < pile.size(); ++i) {
            longest_m = std::max(longest_m, (s.body(pile[i]).position - before[i]).norm());
        }
    }
    EXPECT_GT(budget, 0U) << "more than a frame's work was asked for";
    EXPECT_GT(deferred, 0U) << "more pairs than a body may have at a time";
    EXPECT_EQ(s.fallbacks(Fallback::pairs_deferred), 0U) << "no pair waits in the end";
    EXPECT_LE(narrowphase_calls, 15'000U);
    EXPECT_LE(longest_m, 6.0 * k_half_m);
    EXPECT_LE(s.stats.residual_m, 1e-3) << "the pile is apart in the end";
    EXPECT_GT(spread_m(s, pile), 0.3);
}

TEST(ScenarioBudget, APileElsewhereLeavesAPlayersPushExact) {
    const auto push = [](int crates) {
        Scenario s;
        s.fits_hands = false;
        s.add_rock("rock", 5.0, Vec3(0.3, 1.1, -0.1), 0.08);
        s.add_wall("wall", Vec3(2.0, 2.0, 0.5), Vec3(0.3, 1.2, -0.85));
        s.script.grabs[1] = [](double) { return true; };
        s.script.hands[1] = [](double t_s) {
            return Pose{Vec3(0.3, 1.2, -0.02 - 0.4 * ease(t_s, 0.2, 0.5)), Quat::Identity()};
        };
        add_pile(crates, s);
        s.add_player_here();
        s.run(0.6);
        return s.origin();
    };
    const Vec3 alone = push(0);
    EXPECT_GT(alone.z(), 0.05) << "the wall pushes the player back";
    EXPECT_LE((push(100) - alone).norm(), 1e-9);
}

// Two walls that close around a head and go on until they have passed each other.
TEST(ScenarioBudget, APlayerBetweenClosingWallsNeverJumps) {
    constexpr double k_eject_mps = 3.0;
    for (const double speed_mps : {0.2, 0.5, 1.0, 3.0}) {
        for (const double aside_m : {0.0, 0.03}) {
            Scenario s;
            s.fits_hands = false;
            s.add_player_here();
            s.step();
            const Vec3 head = s.head_center();
            Scenario squeezed;
            squeezed.fits_hands = false;
            for (const double side : {-1.0, 1.0}) {
                const Entity wall =
                    squeezed.add_wall(side < 0.0 ? "left" : "right", Vec3(0.5, 2.0, 2.0),
                                      head + Vec3(side * 0.8 + aside_m, 0.0, 0.0));
                squeezed.set_motion(wall, Vec3(-side * speed_mps, 0.0, 0.0), Vec3::Zero());
            }
            squeezed.add_player_here();
            // Their own motion, the wall and the way out.
            const double limit_m = (2.5 * speed_mps + k_eject_mps) / squeezed.hz;
            const int frames = static_cast<int>(2.0 * squeezed.hz / speed_mps);
            for (int frame = 0; frame < frames; ++frame) {
                const Vec3 before = squeezed.origin();
                squeezed.step();
                ASSERT_LE((squeezed.origin() - before).norm(), limit_m)
                    << speed_mps << " m/s, " << aside_m << " m aside, frame " << frame;
                ASSERT_LE(squeezed.velocity().norm(), 1.5 * speed_mps + 0.1);
            }
        }
    }
}

}  // namespace
}  // namespace handhold::scenario_budget_test
