// Hands near the dead centre of a mechanism, where a hand without a limit of force would give it
// any speed.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_strong_hands_test {
namespace {

using test::Random;

const Vec3 k_half_m(0.3, 0.04, 0.02);
constexpr double k_mass_kg = 3.0;

// Root mean square of the speeds of the body's points, m/s.
double speed_of_points(const Scenario& s, Entity body) {
    const Vec3 spin_bs = s.body(body).rotation.conjugate() * s.body_spin(body);
    const Vec3 inertia = s.world.body.at(body).inertia_kgm2;
    return std::sqrt(s.body_velocity(body).squaredNorm() +
                     spin_bs.cwiseAbs2().dot(inertia) / k_mass_kg);
}

// The velocity of a bar's centre that its hinge demands.
double hinge_error_mps(const Scenario& s, Entity bar, const Vec3& hinge) {
    const Vec3 from_hinge = s.body(bar).position - hinge;
    return (s.body_velocity(bar) - s.body_spin(bar).cross(from_hinge)).norm();
}

// Adds a bar along X at `center`, on a hinge about Y at `hinge`.
Entity add_bar(Scenario& s, const Vec3& center, const Vec3& hinge) {
    const Entity bar = s.add_crate("bar", k_mass_kg, center, k_half_m);
    Joint joint;
    joint.kind = JointKind::hinge;
    joint.b = bar;
    const Pose frame{hinge, rotation_between(Vec3::UnitX(), Vec3::UnitY())};
    add_joint(s.world, {"hinge", joint_at(s.world, joint, frame)});
    return bar;
}

struct Counts {
    int limited = 0;
    double fastest_mps = 0.0;
};

void play(Scenario& s, Entity bar, const Vec3& hinge, Counts& counts) {
    const double limit_mps = s.tuning.locomotion.object_speed_max_mps;
    s.run(1.2, [&] {
        counts.limited += s.fallbacks(Fallback::object_speed_clamped) > 0 ? 1 : 0;
        counts.fastest_mps = std::max(counts.fastest_mps, speed_of_points(s, bar));
        ASSERT_LE(speed_of_points(s, bar), limit_mps + 1e-9) << s.t_s();
        // A limit that scaled the velocity and not the spin would leave metres a second.
        ASSERT_LE(hinge_error_mps(s, bar, hinge), 0.05) << s.t_s();
        ASSERT_LE(s.stats.residual_m, 1e-3) << s.t_s();
    });
}

// Both hands pull the head into a bar, close to its hinge.
TEST(StrongHands, AHeadAtTheHubDoesNotSpinTheBarWithoutBound) {
    Random random(81);
    Counts counts;
    for (int i = 0; i < 20; ++i) {
        Scenario s;
        s.fits_hands = false;
        const double sign = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
        const Vec3 hinge(sign * random.between(0.001, 0.03), 1.6, 0.4);
        const Entity bar = add_bar(s, hinge, hinge);
        s.add_wall("rail", Vec3(0.6, 0.05, 0.5), Vec3(0.0, 1.0, 0.3));
        const double speed_mps = random.between(0.3, 2.5);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const Vec3 hand =
                hand_for_palm(s, Vec3(side == HandSide::left ? -0.3 : 0.3, 1.055, 0.3));
            s.script.hands[index_of(side)] = [hand, speed_mps](double t_s) {
                const double along_m = std::clamp(speed_mps * (t_s - 0.2), 0.0, 0.35);
                return Pose{hand + along_m * Vec3::UnitZ(), Quat::Identity()};
            };
            s.script.grabs[index_of(side)] = [](double t_s) { return t_s > 0.05; };
        }
        s.add_player_here();
        play(s, bar, hinge, counts);
        if (testing::Test::HasFatalFailure()) {
            FAIL() << "case " << i;
        }
    }
    EXPECT_GT(counts.limited, 10);
    EXPECT_GT(counts.fastest_mps, 1.0);
}

}  // namespace
}  // namespace handhold::scenario_strong_hands_test
