// sin_cos and arc_tangent2 against the C library in long double.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/math.hpp"

namespace handhold::trigonometry_test {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_tiny = std::numeric_limits<double>::denorm_min();
constexpr double k_huge = std::numeric_limits<double>::max();

// With both signs: numbers of all magnitudes, samples of [0, 1e3], and neighbours of the multiples
// of pi/2.
std::vector<double> many_angles() {
    std::vector<double> angles = {0.0, k_tiny, 1e3};
    for (double angle = 1e-320; angle < 1e3; angle *= 1.7) {
        angles.push_back(angle);
    }
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(0.0, 1e3);
    for (int i = 0; i < 100000; ++i) {
        angles.push_back(any(random));
    }
    for (int quarter = 0; quarter <= 636; ++quarter) {
        const double centre = quarter * (0.5 * k_pi);
        for (const double offset : {0.0, 1e-16, 1e-13, 1e-9, 1e-4, 0.25 * k_pi}) {
            angles.push_back(centre + offset);
            angles.push_back(centre - offset);
        }
        angles.push_back(std::nextafter(centre, 0.0));
        angles.push_back(std::nextafter(centre, k_huge));
    }
    const std::size_t count = angles.size();
    for (std::size_t i = 0; i < count; ++i) {
        angles.push_back(-angles[i]);
    }
    return angles;
}

// Oracle: the C library in long double (64-bit mantissa).
double sin_cos_error(double angle_rad) {
    double sine = 0.0;
    double cosine = 0.0;
    sin_cos(angle_rad, sine, cosine);
    const auto wide = static_cast<long double>(angle_rad);
    const long double error = std::max(std::abs(static_cast<long double>(sine) - std::sin(wide)),
                                       std::abs(static_cast<long double>(cosine) - std::cos(wide)));
    return static_cast<double>(error);
}

double arc_tangent_error(double y, double x) {
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    return static_cast<double>(std::abs(static_cast<long double>(arc_tangent2(y, x)) - exact));
}

TEST(SinCos, MatchesLongDoubleWithin1e15UpTo1e3) {
    double worst = 0.0;
    for (const double angle : many_angles()) {
        worst = std::max(worst, sin_cos_error(angle));
    }
    RecordProperty("worst_error", std::to_string(worst * 1e16) + "e-16");
    EXPECT_LT(worst, 1e-15);
}

TEST(SinCos, MatchesLongDoubleWithin1e14UpTo1e6) {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> any(-1e6, 1e6);
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i) {
        worst = std::max(worst, sin_cos_error(any(random)));
    }
    EXPECT_LT(worst, 1e-14);
}

TEST(SinCos, TinyAnglesAreTheirOwnSine) {
    for (const double angle : {k_tiny, 1e-310, 1e-200, 1e-20, 1e-9}) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(-angle, sine, cosine);
        EXPECT_EQ(sine, -angle);  // sin x = x - x^3/6
        EXPECT_EQ(cosine, 1.0);
    }
    double sine = 1.0;
    double cosine = 0.0;
    sin_cos(-0.0, sine, cosine);
    EXPECT_FALSE(std::signbit(sine)) << "-0.0 is 0.0: one state, one hash";
}

TEST(SinCos, InvalidAngleActsAsZero) {
    for (const double angle : {k_nan, k_infinity, -k_infinity, k_huge, -1e6}) {
        double sine = 7.0;
        double cosine = 7.0;
        sin_cos(angle, sine, cosine);
        EXPECT_EQ(sine, 0.0);
        EXPECT_EQ(cosine, 1.0);
    }
}

TEST(ArcTangent2, MatchesLongDoubleWithin1e15InAllDirections) {
    double worst = 0.0;
    std::mt19937_64 random(13);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::uniform_real_distribution<double> exponent(-300.0, 300.0);
    for (int i = 0; i < 200000; ++i) {
        const double y = any(random);
        const double x = any(random);
        const double scale = std::pow(10.0, exponent(random));
        worst = std::max(worst, arc_tangent_error(y, x));
        worst = std::max(worst, arc_tangent_error(y * scale, x));
    }
    RecordProperty("worst_error", std::to_string(worst * 1e16) + "e-16");
    EXPECT_LT(worst, 1e-15);
}

TEST(ArcTangent2, MatchesLongDoubleOnAxesDiagonalsAndExtremes) {
    const std::vector<double> numbers = {0.0, k_tiny, 1e-300, 1e-8,      1.0,
                                         3.0, 1e300,  k_huge, k_infinity};
    for (const double ay : numbers) {
        for (const double ax : numbers) {
            for (const double y : {ay, -ay}) {
                for (const double x : {ax, -ax}) {
                    if (y == 0.0 && x == 0.0) {
                        continue;
                    }
                    // + 0.0 turns -0.0, which libm gives a sign, into 0.0.
                    EXPECT_LT(arc_tangent_error(y + 0.0, x + 0.0), 1e-15) << y << ' ' << x;
                    EXPECT_EQ(arc_tangent2(y, x), arc_tangent2(y + 0.0, x + 0.0)) << y << ' ' << x;
                }
            }
        }
    }
}

TEST(ArcTangent2, ZeroVectorAndNaNGiveZero) {
    for (const double zero : {0.0, -0.0}) {
        EXPECT_EQ(arc_tangent2(zero, 0.0), 0.0);
        EXPECT_EQ(arc_tangent2(zero, -0.0), 0.0);
    }
    EXPECT_EQ(arc_tangent2(k_nan, 1.0), 0.0);
    EXPECT_EQ(arc_tangent2(1.0, k_nan), 0.0);
    EXPECT_EQ(arc_tangent2(k_nan, k_infinity), 0.0);
}

TEST(ArcTangent2, InvertsSinCos) {
    for (double angle = -3.14; angle < 3.14; angle += 0.01) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(angle, sine, cosine);
        EXPECT_NEAR(arc_tangent2(sine, cosine), angle, 2e-15);
    }
}

}  // namespace
}  // namespace handhold::trigonometry_test
