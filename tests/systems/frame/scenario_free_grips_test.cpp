// A player who holds only free bodies is never moved by them, even where the hands press the bodies
// into each other.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_free_grips_test {
namespace {

using test::Random;

// A body under each palm, below PhaseTuning::kappa_light_kg, 10 to 20 cm across.
Entity add_random_body(const std::string& name, const Vec3& palm, Random& random, Scenario& s) {
    const double mass_kg = std::exp(random.between(std::log(0.2), std::log(90.0)));
    const double half_m = random.between(0.05, 0.1);
    const Vec3 center = palm - (half_m + 0.005) * Vec3::UnitY();
    return random.between(0.0, 1.0) < 0.5
               ? s.add_rock(name, mass_kg, center, half_m)
               : s.add_crate(name, mass_kg, center,
                             {random.between(0.05, 0.1), half_m, random.between(0.05, 0.1)});
}

struct Sway {
    Vec3 size_m = Vec3::Zero();
    Vec3 turn_rad = Vec3::Zero();
    double rate = 0.0;  // rad/s
};

Sway random_sway(Random& random) {
    const Vec3 size_m = random.vector(0.15);
    const Vec3 turn_rad = random.vector(0.5);
    return {size_m, turn_rad, random.between(1.0, 8.0)};
}

TEST(FreeGrips, BodiesPressedIntoEachOtherNeverMoveThePlayer) {
    int pressed_frames = 0;
    int held_frames = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        Scenario s;
        s.fits_hands = false;
        const double spread_m = 0.25;
        for (std::size_t i = 0; i < k_hand_count; ++i) {
            const double side = i == 0 ? -1.0 : 1.0;
            const Vec3 palm(side * spread_m, 1.2, 0.0);
            add_random_body("body" + std::to_string(i), palm, random, s);
            const Vec3 rest = hand_for_palm(s, palm);
            const Sway sway = random_sway(random);
            // Both hands move to the middle, then sway: the bodies are pressed into each other.
            s.script.hands[i] = [=](double t_s) {
                const double inward_m = side * (spread_m - 0.02) * ease(t_s, 0.2, 0.7);
                const double wave = ease(t_s, 0.2, 0.7) * std::sin(sway.rate * t_s);
                return Pose{rest - inward_m * Vec3::UnitX() + wave * sway.size_m,
                            rotation_from_vector(wave * sway.turn_rad)};
            };
            s.script.grabs[i] = [](double t_s) { return t_s > 0.05; };
        }
        // A loose body that the held ones may meet.
        const double mass_kg = random.between(0.5, 50.0);
        s.add_rock("loose", mass_kg, Vec3(random.between(-0.3, 0.3), 1.1, -0.3));
        s.add_player_here();
        const Vec3 origin = s.origin_ws();
        s.run(2.0, [&] {
            ASSERT_EQ(s.origin_ws(), origin) << "seed " << seed << ", t " << s.t_s();  // bitwise
            ASSERT_EQ(s.velocity(), Vec3(Vec3::Zero())) << "seed " << seed << ", t " << s.t_s();
            const bool holds_both = s.grab(HandSide::left).kind == GripKind::held &&
                                    s.grab(HandSide::right).kind == GripKind::held;
            held_frames += holds_both ? 1 : 0;
            pressed_frames += holds_both && s.stats.hand_error_m > 0.01 ? 1 : 0;
        });
    }
    EXPECT_GT(held_frames, 40 * 90);
    EXPECT_GT(pressed_frames, 1000);
}

}  // namespace
}  // namespace handhold::scenario_free_grips_test
