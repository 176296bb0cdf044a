#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/systems/body/body_columns.hpp"

namespace handhold::crossed_hands_test {
namespace {

using test::Random;

// Hands in front of the chest, the right one `crossed_m` to the left of the left one, at different
// distances. Returns how far the chest then faces to the side of the look, degrees.
double turn_deg(Random& random, double crossed_m) {
    const Vec3 eyes(0.0, 1.6, 0.0);
    const auto hand = [&](double side_m) {
        const double below_m = random.between(0.25, 0.5);
        const double ahead_m = random.between(0.15, 0.45);
        return Pose{eyes + Vec3(side_m, -below_m, -ahead_m),
                    rotation_about(Vec3::UnitY(), random.between(-0.5, 0.5))};
    };
    test::BodyColumns columns;
    columns.add_player();
    columns.place({eyes, Quat::Identity()}, hand(0.5 * crossed_m), hand(-0.5 * crossed_m));
    columns.estimate_arms(1.0 / 90.0);
    const Vec3 facing = columns.estimate.at(test::k_player).facing_ps;
    return std::abs(std::atan2(facing.x(), -facing.z())) / k_degree;
}

// A line between crossed hands runs from right to left: it cannot tell where the chest faces.
TEST(CrossedHands, TurnTheChestLittle) {
    Random random(53);
    constexpr int k_bodies = 2000;
    double sum_deg = 0.0;
    double most_deg = 0.0;
    for (int i = 0; i < k_bodies; ++i) {
        const double deg = turn_deg(random, random.between(0.05, 0.3));
        sum_deg += deg;
        most_deg = std::max(most_deg, deg);
    }
    RecordProperty("mean_deg", std::to_string(sum_deg / k_bodies));
    RecordProperty("most_deg", std::to_string(most_deg));
    EXPECT_LT(sum_deg / k_bodies, 8.0);
    EXPECT_LT(most_deg, 30.0);
}

}  // namespace
}  // namespace handhold::crossed_hands_test
