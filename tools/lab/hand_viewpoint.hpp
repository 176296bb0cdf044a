#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "engine/math/math.hpp"

// Chooses the best viewpoint for a posed hand on a mesh.
namespace handhold::lab {

struct HandCapsule {
    std::string finger;  // "thumb" ... "little", or "palm"
    std::uint32_t link = 0;
    Vec3 a_m = Vec3::Zero();
    Vec3 b_m = Vec3::Zero();
    double radius_m = 0.0;
};

struct HandView {
    Vec3 center = Vec3::Zero();    // centre of the hand
    double radius_m = 0.1;         // radius of a sphere around the centre that contains the hand
    Vec3 towards = Vec3::UnitZ();  // unit, from the hand to the eye
};

using Triangle = std::array<Vec3, 3>;

// The triangles of all meshes that are within `reach_m` of the point.
std::vector<Triangle> triangles_near(std::span<const Mesh> meshes, const Vec3& point,
                                     double reach_m);

// Chooses, among evenly spread viewing directions, the one from which most of the fingers can be
// seen at `distance_m`. Triangles and the hand itself hide fingers. Prefers views from beside the
// hand, which show gaps and penetrating fingers. With `other`, the direction is at least 70 degrees
// from that of `other`.
HandView choose_hand_view(std::span<const HandCapsule> capsules, const Quat& wrist,
                          std::span<const Triangle> around, double distance_m,
                          const HandView* other = nullptr);
// Only the bounding sphere.
HandView hand_bounds(std::span<const HandCapsule> capsules);

}  // namespace handhold::lab
