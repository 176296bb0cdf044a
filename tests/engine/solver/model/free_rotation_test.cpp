#include "engine/solver/model/free_rotation.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/wide_rotation.hpp"
#include "tests/random.hpp"

namespace handhold::solver_free_rotation_test {
namespace {

using test::Random;

constexpr double k_dt_s = 1.0 / 90.0;

struct Body {
    Vec3 inertia_kgm2;
    Quat rotation;
    Vec3 spin_radps;
};

// Spheres, symmetric tops about each axis and bodies with three different moments; slow and fast.
Body random_body(std::size_t kind, Random& random) {
    const double a = random.between(0.1, 1.0);
    const double b = random.between(0.1, 1.0);
    const Vec3 inertias[] = {Vec3(a, a, a), Vec3(a, b, b), Vec3(b, a, b), Vec3(b, b, a),
                             Vec3(a, b, 0.5 * (a + b))};
    return {inertias[kind % 5], random.rotation(), random.vector(kind % 3 == 0 ? 300.0 : 3.0)};
}

std::vector<Body> random_bodies(Random& random) {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < 37; ++i) {
        bodies.push_back(random_body(i, random));
    }
    return bodies;
}

void advance(std::vector<Body>& bodies, Vectors vectors = fastest_vectors()) {
    FreeRotations rotations(k_dt_s, vectors);
    for (Body& body : bodies) {
        rotations.add(body.inertia_kgm2, body.rotation, body.spin_radps);
    }
    rotations.finish();
}

void expect_same_bits(const Body& x, const Body& y) {
    EXPECT_EQ(x.rotation.coeffs(), y.rotation.coeffs());
    EXPECT_EQ(x.spin_radps, y.spin_radps);
}

TEST(FreeRotations, BodyDoesNotDependOnTheOthersOfItsBatch) {
    Random random(1);
    std::vector<Body> together = random_bodies(random);
    std::vector<Body> alone = together;
    advance(together);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        SCOPED_TRACE(i);
        std::vector<Body> one = {alone[i]};
        advance(one);
        EXPECT_NE(one[0].rotation.coeffs(), alone[i].rotation.coeffs());
        expect_same_bits(one[0], together[i]);
    }
}

TEST(FreeRotations, BitsAreEqualWithAndWithoutAvx2) {
    if (fastest_vectors() == Vectors::portable) {
        GTEST_SKIP() << "this processor has no AVX2";
    }
    Random random(2);
    for (int round = 0; round < 20; ++round) {
        std::vector<Body> fast = random_bodies(random);
        std::vector<Body> portable = fast;
        advance(fast);
        advance(portable, Vectors::portable);
        for (std::size_t i = 0; i < fast.size(); ++i) {
            SCOPED_TRACE(i);
            expect_same_bits(fast[i], portable[i]);
        }
    }
}

TEST(FreeRotations, ZeroExcessiveAndInvalidSpinsAreLeftUnchanged) {
    Random random(3);
    for (const Vec3& spin : {Vec3(0.0, 0.0, 0.0), Vec3(2e6, 0.0, 0.0),
                             Vec3(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0)}) {
        std::vector<Body> bodies = {random_body(4, random)};
        bodies[0].spin_radps = spin;
        const Quat before = bodies[0].rotation;
        advance(bodies);
        EXPECT_EQ(bodies[0].rotation.coeffs(), before.coeffs());
    }
}

// Compared with math.hpp's scalar sin_cos.
TEST(SinCos, FourLanesHaveTheBitsOfTheScalarFunction) {
    Random random(4);
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    std::vector<double> angles = {
        0.0,   -0.0,       1e6,         -1e6,
        1e300, k_infinity, -k_infinity, std::numeric_limits<double>::quiet_NaN()};
    for (int i = 0; i < 4000; ++i) {
        angles.push_back(random.between(-10.0, 10.0) * (i % 4 == 0 ? 1e4 : 1.0));
    }
    for (std::size_t i = 0; i < angles.size(); i += 4) {
        Double4 sines;
        Double4 cosines;
        sin_cos(Double4{angles[i], angles[i + 1], angles[i + 2], angles[i + 3]}, sines, cosines);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            double sine = 0.0;
            double cosine = 0.0;
            sin_cos(angles[i + lane], sine, cosine);
            EXPECT_EQ(std::bit_cast<std::uint64_t>(sine), std::bit_cast<std::uint64_t>(sines[lane]))
                << angles[i + lane];
            EXPECT_EQ(std::bit_cast<std::uint64_t>(cosine),
                      std::bit_cast<std::uint64_t>(cosines[lane]))
                << angles[i + lane];
        }
    }
}

}  // namespace
}  // namespace handhold::solver_free_rotation_test
