#pragma once

#include <cstdint>
#include <vector>

#include "engine/math/math.hpp"

// Contact reduction: of the contacts of one pair, keeps the outermost ones.
namespace handhold {

inline constexpr double k_same_place_m = 1e-6;  // points nearer than this are merged

// A contact point of one pair in near space: b's axes with the origin at a's position.
struct NearContact {
    Vec3 point_a_ns = Vec3::Zero();  // point on a's surface
    Vec3 point_b_ns = Vec3::Zero();  // point on b's surface
    Vec3 normal_ns = Vec3::UnitY();  // unit, from b towards a
    double separation_m = 0.0;       // normal_ns . (point_a_ns - point_b_ns); negative: penetration
    std::uint32_t part = 0;          // index of a's part, for a compound
};

// Sorts contacts by position and merges duplicates. Of each group with (nearly) equal normals,
// keeps the deepest and at most 8 corners of the outline. The removed contacts would be redundant
// constraint rows: a rigid body that satisfies the corners satisfies them too. `scratch`: memory
// for reuse; its content is overwritten.
void reduce_contacts(std::vector<NearContact>& contacts, std::vector<NearContact>& scratch);

}  // namespace handhold
