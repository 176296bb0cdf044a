#include "engine/anim/skinning.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace handhold {
std::uint16_t heaviest_joint(const SkinWeights& weights) {
    std::size_t heaviest = 0;
    for (std::size_t k = 1; k < weights.weight.size(); ++k) {
        if (weights.weight[k] > weights.weight[heaviest]) {
            heaviest = k;
        }
    }
    return weights.joint[heaviest];
}

void skin_vertices(const SkinVerticesInput& input, std::vector<Vec3>& positions,
                   std::vector<Vec3>& normals) {
    HH_CHECK(input.weights.size() == input.positions.size() &&
                 input.normals.size() == input.positions.size(),
             "weights and normals by vertex", input.weights.size());
    std::size_t joints = 0;
    for (const SkinWeights& weights : input.weights) {
        for (const std::uint16_t joint : weights.joint) {
            joints = std::max(joints, joint + std::size_t{1});
        }
    }
    HH_CHECK(joints <= input.carry.size(), "a transform for each joint", input.carry.size());
    positions.resize(input.positions.size());
    normals.resize(input.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Mat3 turn = Mat3::Zero();
        Vec3 move = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) {
            const double weight = static_cast<double>(input.weights[i].weight[k]);
            const Affine& carry = input.carry[input.weights[i].joint[k]];
            turn += weight * carry.linear;
            move += weight * carry.translation;
        }
        positions[i] = turn * input.positions[i] + move;
        const Vec3 normal = transform_normal(turn, input.normals[i]);
        const double length = normal.norm();
        normals[i] = length > 1e-12 ? Vec3(normal / length) : input.normals[i];
    }
}

}  // namespace handhold
