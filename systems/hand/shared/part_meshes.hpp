#pragma once

#include <cstddef>
#include <map>
#include <utility>

#include "engine/geometry/grip_mesh.hpp"
#include "systems/rigs/body_capsules.hpp"

namespace handhold {

inline constexpr double k_min_part_m = 1e-3;  // smaller lengths and radii count as this, m
// Meshes kept from frame to frame; each takes 1 to 2 MB.
inline constexpr std::size_t k_many_part_meshes = 64;

// The capsule in the metres of hands of that scale (PlayerOrigin::scale).
inline PartCapsule resized(const PartCapsule& capsule, double scale) {
    return {capsule.frame_ws, capsule.end_bs / scale, capsule.radius_m / scale};
}

// Grip meshes of the capsules of shown bodies. Lengths and radii are rounded to seven significant
// bits, so that players share meshes and a stretched arm needs few. A cache: a mesh depends on the
// rounded sizes alone.
class PartMeshes {
  public:
    // Rounded length of the axis and radius, m of the hand's scale.
    using Size = std::pair<double, double>;
    static Size size_of(const PartCapsule& capsule);
    // Forgets all meshes if there are more than k_many_part_meshes and more than two for each of
    // `held` parts. For the begin of a frame, before add(): pointers from find() end.
    void drop_if_many(std::size_t held);
    // Builds the capsule's mesh if it is missing. Not for several threads at once.
    void add(const PartCapsule& capsule);
    // Null if no capsule of this size was added.
    const GripMesh* find(const PartCapsule& capsule) const;
    std::size_t size() const { return mesh_of_size_.size(); }  // number of meshes
    // The mesh's frame in the part's frame: the origin is the middle of the capsule's axis, +Y
    // along it.
    static Pose frame_of_mesh(const PartCapsule& capsule);

  private:
    std::map<Size, GripMesh> mesh_of_size_;
};

}  // namespace handhold
