// natural_logarithm and cube_root against the C library in long double.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/math/math.hpp"

namespace handhold::elementary_test {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_tiny = std::numeric_limits<double>::denorm_min();
constexpr double k_huge = std::numeric_limits<double>::max();

// Positive numbers of all magnitudes, denormals too, and many near 1.
template <typename Check>
void for_many_numbers(Check&& check) {
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> exponent(-1074.0, 1023.9);
    std::uniform_real_distribution<double> near_one(0.4, 2.5);
    for (int i = 0; i < 200000; ++i) {
        check(std::exp2(exponent(random)));
        check(near_one(random));
    }
    for (const double x :
         {k_tiny, 1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), k_huge}) {
        check(x);
    }
}

TEST(NaturalLogarithm, MatchesLongDoubleWithin1e15) {
    for_many_numbers([](double x) {
        const long double exact = std::log(static_cast<long double>(x));
        const long double error = static_cast<long double>(natural_logarithm(x)) - exact;
        ASSERT_LE(std::abs(error), 1e-15L * std::abs(exact)) << x;
    });
}

TEST(NaturalLogarithm, HasAValueForEveryNumber) {
    EXPECT_EQ(natural_logarithm(1.0), 0.0);
    EXPECT_EQ(natural_logarithm(0.0), -k_infinity);
    EXPECT_EQ(natural_logarithm(-1.0), -k_infinity);
    EXPECT_EQ(natural_logarithm(k_infinity), k_infinity);
    EXPECT_TRUE(std::isnan(natural_logarithm(k_nan)));
}

TEST(CubeRoot, MatchesLongDoubleWithin1e15) {
    for_many_numbers([](double x) {
        const long double exact = std::cbrt(static_cast<long double>(x));
        const long double error = static_cast<long double>(cube_root(x)) - exact;
        ASSERT_LE(std::abs(error), 1e-15L * exact) << x;
    });
}

TEST(CubeRoot, HasAValueForEveryNumber) {
    EXPECT_EQ(cube_root(0.0), 0.0);
    EXPECT_EQ(cube_root(k_infinity), k_infinity);
    EXPECT_TRUE(std::isnan(cube_root(-1.0)));
    EXPECT_TRUE(std::isnan(cube_root(k_nan)));
    for (const double root : {1.0, 2.0, 3.0, 10.0, 0.5}) {
        EXPECT_NEAR(cube_root(root * root * root), root, 1e-15 * root);
    }
}

// Halfway between two rotations is as far from either, and the way to a quarter is half of it.
TEST(InterpolatedRotation, IsAtTheShareOfTheAngle) {
    std::mt19937_64 random(22);
    std::normal_distribution<double> any;
    const auto rotation = [&] {
        return Quat{any(random), any(random), any(random), any(random)}.normalized();
    };
    for (int i = 0; i < 2000; ++i) {
        const Quat a = rotation();
        const Quat b = rotation();
        const double angle = rotation_to_vector(a.conjugate() * b).norm();
        for (const double share : {0.0, 0.25, 0.5, 0.8, 1.0}) {
            const Quat between = interpolate(a, b, share);
            EXPECT_NEAR(rotation_to_vector(a.conjugate() * between).norm(), share * angle, 1e-12);
            EXPECT_NEAR(rotation_to_vector(between.conjugate() * b).norm(), (1.0 - share) * angle,
                        1e-12);
        }
    }
}

}  // namespace
}  // namespace handhold::elementary_test
