#include "engine/anim/skinning.hpp"

#include "engine/core/check.hpp"

namespace handhold {

void skin_vertices(const SkinVerticesInput& input, std::vector<Vec3>& positions,
                   std::vector<Vec3>& normals) {
    HH_CHECK(input.weights.size() == input.positions.size() &&
                 input.normals.size() == input.positions.size(),
             "weights and normals by vertex", input.weights.size());
    HH_CHECK(input.bind.size() == input.pose.size(), "a pose for each joint", input.pose.size());
    std::vector<Mat3> turns(input.bind.size());
    std::vector<Vec3> moves(input.bind.size());
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const Pose carry = input.pose[i] * inverse(input.bind[i]);
        turns[i] = carry.rotation.toRotationMatrix();
        moves[i] = carry.position;
    }
    positions.resize(input.positions.size());
    normals.resize(input.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Mat3 turn = Mat3::Zero();
        Vec3 move = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) {
            const double weight = static_cast<double>(input.weights[i].weight[k]);
            turn += weight * turns[input.weights[i].joint[k]];
            move += weight * moves[input.weights[i].joint[k]];
        }
        positions[i] = turn * input.positions[i] + move;
        const Vec3 normal = turn * input.normals[i];
        const double length = normal.norm();
        normals[i] = length > 1e-12 ? Vec3(normal / length) : input.normals[i];
    }
}

}  // namespace handhold
