#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "engine/math/math.hpp"

// Where a posed hand on a mesh is best seen from.
namespace handhold::lab {

struct HandCapsule {
    std::string finger;  // "thumb" ... "little", or "palm"
    std::uint32_t link = 0;
    Vec3 a_m = Vec3::Zero();
    Vec3 b_m = Vec3::Zero();
    double radius_m = 0.0;
};

struct HandView {
    Vec3 center = Vec3::Zero();    // of the hand
    double radius_m = 0.1;         // of a sphere about it that holds the hand
    Vec3 towards = Vec3::UnitZ();  // unit, from the hand to the eye
};

using Triangle = std::array<Vec3, 3>;

// Of all meshes, the triangles within `reach_m` of the point.
std::vector<Triangle> triangles_near(std::span<const Mesh> meshes, const Vec3& point,
                                     double reach_m);

// Of directions spread evenly, the one from which most of the fingers is seen at `distance_m`,
// neither behind the triangles nor behind the hand itself; of such, one from beside the hand, where
// gaps and sunk fingers show.
HandView choose_hand_view(std::span<const HandCapsule> capsules, const Quat& wrist,
                          std::span<const Triangle> around, double distance_m);
// The sphere only.
HandView hand_bounds(std::span<const HandCapsule> capsules);

}  // namespace handhold::lab
