#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

// A small feed-forward network. It is evaluated in one fixed order, in floats, with nothing but
// arithmetic and square roots, so the results are equal for all compilers.
namespace handhold {

// One hidden layer. With z = (x - mean) * inverse_deviation, limited to +-4:
//     y = W1' a(W0' z + b0) + b1,    a(v) = v / sqrt(1 + v^2).
// Weights are stored by input: weights[i * outputs + j] leads from input i to output j. As |a| < 1,
// |y_j| is at most |b1_j| plus the sum of |W1_ij| over i.
template <std::size_t Inputs, std::size_t Hidden, std::size_t Outputs>
struct BodyNetwork {
    std::array<float, Inputs> mean;
    std::array<float, Inputs> inverse_deviation;  // 1 / standard deviation of the data
    std::array<float, Inputs * Hidden> weights0;
    std::array<float, Hidden> bias0;
    std::array<float, Hidden * Outputs> weights1;
    std::array<float, Outputs> bias1;
    // Mean squares of the inputs, in standard deviations, between which `familiarity` falls from 1
    // to 0. The mean square is about 1 for the data of the fit.
    double familiar;
    double foreign;
};

template <std::size_t Outputs>
struct NetworkAnswer {
    std::array<float, Outputs> values;
    // 1 if the inputs resemble the data that the network was fitted on, falling smoothly to 0 for
    // inputs that do not.
    double familiarity;
};

// y[j] + sum over i of weights[i * Outputs + j] * x[i], in the order of i. Four outputs at a time
// where Outputs is a multiple of 4.
template <std::size_t Inputs, std::size_t Outputs>
std::array<float, Outputs> add_layer(const std::array<float, Inputs>& x,
                                     const std::array<float, Inputs * Outputs>& weights,
                                     std::array<float, Outputs> y) {
    if constexpr (Outputs % 4 == 0) {
        std::array<Float4, Outputs / 4> sums;
        std::memcpy(sums.data(), y.data(), sizeof(y));
        for (std::size_t i = 0; i < Inputs; ++i) {
            const Float4 input = splat4(x[i]);
            for (std::size_t k = 0; k < sums.size(); ++k) {
                Float4 weight;
                std::memcpy(&weight, weights.data() + i * Outputs + 4 * k, sizeof(weight));
                sums[k] += weight * input;
            }
        }
        std::memcpy(y.data(), sums.data(), sizeof(y));
        return y;
    }
    for (std::size_t i = 0; i < Inputs; ++i) {
        const float input = x[i];
        for (std::size_t j = 0; j < Outputs; ++j) {
            y[j] += weights[i * Outputs + j] * input;
        }
    }
    return y;
}

template <std::size_t Inputs, std::size_t Hidden, std::size_t Outputs>
NetworkAnswer<Outputs> evaluate(const BodyNetwork<Inputs, Hidden, Outputs>& network,
                                std::array<float, Inputs> x) {
    constexpr float k_limit = 4.0F;
    constexpr float k_far = 1e6F;  // keeps squares finite
    float squares = 0.0F;
    for (std::size_t i = 0; i < Inputs; ++i) {
        const float scaled = (x[i] - network.mean[i]) * network.inverse_deviation[i];
        const float z = std::clamp(scaled, -k_far, k_far);
        squares += z * z;
        x[i] = std::clamp(z, -k_limit, k_limit);
    }
    std::array<float, Hidden> hidden = add_layer(x, network.weights0, network.bias0);
    for (float& value : hidden) {
        value = value / std::sqrt(1.0F + value * value);
    }
    const double mean_square = static_cast<double>(squares) / static_cast<double>(Inputs);
    return {add_layer(hidden, network.weights1, network.bias1),
            1.0 - smooth_step(mean_square, network.familiar, network.foreign)};
}

}  // namespace handhold
