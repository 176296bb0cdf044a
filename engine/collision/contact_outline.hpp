#pragma once

#include <cstdint>
#include <vector>

#include "engine/math/math.hpp"

// Of many contact points of one pair those that hold it.
namespace handhold {

inline constexpr double k_same_place_m = 1e-6;  // points nearer than this are one

// A contact point of one pair in near space: b's axes about a's place.
struct NearContact {
    Vec3 point_a_ns = Vec3::Zero();  // on a's surface
    Vec3 point_b_ns = Vec3::Zero();  // on b's surface
    Vec3 normal_ns = Vec3::UnitY();  // unit, from b towards a
    double separation_m = 0.0;       // normal . (point_a - point_b)
    std::uint32_t part = 0;          // of a, where it has several
};

// Sorts contacts by place, merges equal ones, and leaves of each group of (nearly) equal normal
// only what bounds the rest: the corners of its outline, at most 8, and the deepest. The others
// would be redundant rows: a rigid body that meets the corners meets them. `scratch` is any vector:
// its content is lost, its memory is reused.
void reduce_contacts(std::vector<NearContact>& contacts, std::vector<NearContact>& scratch);

}  // namespace handhold
