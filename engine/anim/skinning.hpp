#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Meshes that follow joints.
namespace handhold {

// Up to four joints carry a vertex.
struct SkinWeights {
    std::array<std::uint16_t, 4> joint = {};
    std::array<float, 4> weight = {};  // not negative; their sum is 1
};

// The joint that carries most of a vertex; of equal ones the first.
std::uint16_t heaviest_joint(const SkinWeights& weights);

struct SkinVerticesInput {
    std::span<const Vec3> positions;
    std::span<const Vec3> normals;         // by vertex, unit
    std::span<const SkinWeights> weights;  // by vertex; joints below the number of joints
    std::span<const Affine> carry;         // by joint: from the bind to where it takes them now
};

// Linear blend skinning: each vertex goes where its joints carry it, in the mean. Sizes of the
// outputs become those of the input; normals stay unit, and square to surfaces that are scaled.
void skin_vertices(const SkinVerticesInput& input, std::vector<Vec3>& positions,
                   std::vector<Vec3>& normals);

}  // namespace handhold
