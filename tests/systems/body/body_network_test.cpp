#include "systems/body/shared/body_network.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::body_network_test {
namespace {

using test::Random;
using Network = BodyNetwork<5, 7, 3>;

template <std::size_t Size>
std::array<float, Size> random_values(Random& random, double size) {
    std::array<float, Size> values{};
    for (float& value : values) {
        value = static_cast<float>(random.between(-size, size));
    }
    return values;
}

Network random_network(Random& random) {
    return {random_values<5>(random, 1.0),
            {1.0F, 2.0F, 0.5F, 1.5F, 1.0F},
            random_values<35>(random, 1.0),
            random_values<7>(random, 1.0),
            random_values<21>(random, 1.0),
            random_values<3>(random, 1.0),
            3.0,
            8.0};
}

// Oracle: the documented equation in double precision.
TEST(BodyNetwork, EqualsTheDocumentedEquation) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Network network = random_network(random);
        const std::array<float, 5> x = random_values<5>(random, 6.0);
        std::array<double, 7> hidden{};
        std::array<double, 5> z{};
        for (std::size_t k = 0; k < 5; ++k) {
            z[k] = std::clamp((static_cast<double>(x[k]) - static_cast<double>(network.mean[k])) *
                                  static_cast<double>(network.inverse_deviation[k]),
                              -4.0, 4.0);
        }
        for (std::size_t j = 0; j < 7; ++j) {
            hidden[j] = static_cast<double>(network.bias0[j]);
            for (std::size_t k = 0; k < 5; ++k) {
                hidden[j] += static_cast<double>(network.weights0[k * 7 + j]) * z[k];
            }
            hidden[j] /= std::sqrt(1.0 + hidden[j] * hidden[j]);
        }
        const auto answer = evaluate(network, x);
        for (std::size_t j = 0; j < 3; ++j) {
            double expected = static_cast<double>(network.bias1[j]);
            for (std::size_t k = 0; k < 7; ++k) {
                expected += static_cast<double>(network.weights1[k * 3 + j]) * hidden[k];
            }
            EXPECT_NEAR(static_cast<double>(answer.values[j]), expected, 1e-5);
        }
    }
}

TEST(BodyNetwork, AnswersAreBoundedForAnyInput) {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const Network network = random_network(random);
        const auto answer = evaluate(network, random_values<5>(random, std::pow(10.0, i % 38)));
        EXPECT_GE(answer.familiarity, 0.0);
        EXPECT_LE(answer.familiarity, 1.0);
        for (std::size_t j = 0; j < 3; ++j) {
            double most = std::abs(static_cast<double>(network.bias1[j]));
            for (std::size_t k = 0; k < 7; ++k) {
                most += std::abs(static_cast<double>(network.weights1[k * 3 + j]));
            }
            EXPECT_LE(std::abs(static_cast<double>(answer.values[j])), most + 1e-5);
        }
    }
}

TEST(BodyNetwork, MeanInputIsFamiliarAndFarInputIsNot) {
    Random random(3);
    const Network network = random_network(random);
    EXPECT_EQ(evaluate(network, network.mean).familiarity, 1.0);
    EXPECT_EQ(evaluate(network, {50.0F, 50.0F, 50.0F, 50.0F, 50.0F}).familiarity, 0.0);
}

}  // namespace
}  // namespace handhold::body_network_test
