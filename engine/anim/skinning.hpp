#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Linear blend skinning.
namespace handhold {

// The joints that move a vertex, and their weights.
struct SkinWeights {
    std::array<std::uint16_t, 4> joint = {};
    std::array<float, 4> weight = {};  // >= 0; sum is 1
};

// The joint with the largest weight; of several with equal weights, the first.
std::uint16_t heaviest_joint(const SkinWeights& weights);

struct SkinVerticesInput {
    std::span<const Vec3> positions;
    std::span<const Vec3> normals;         // one per vertex, unit length
    std::span<const SkinWeights> weights;  // one per vertex; joint indices < carry.size()
    std::span<const Affine>
        carry;  // one per joint: transform from its bind pose to its current pose
};

// Moves each vertex by the weighted mean of its joints' transforms. Resizes the outputs to the
// input's size. Normals stay unit and perpendicular to scaled surfaces.
void skin_vertices(const SkinVerticesInput& input, std::vector<Vec3>& positions,
                   std::vector<Vec3>& normals);

}  // namespace handhold
