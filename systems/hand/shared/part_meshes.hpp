#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "engine/geometry/grip_mesh.hpp"
#include "systems/rigs/body_capsules.hpp"

namespace handhold {

inline constexpr double k_length_step_m = 0.01;
inline constexpr double k_radius_step_m = 0.001;

// The capsule in the metres of hands of that scale (PlayerOrigin::scale).
inline PartCapsule resized(const PartCapsule& capsule, double scale) {
    return {capsule.frame_ws, capsule.end_bs / scale, capsule.radius_m / scale};
}

// Grip meshes of the capsules of shown bodies. Lengths are rounded to k_length_step_m and radii to
// k_radius_step_m, so that players share meshes and a stretched arm needs few. A cache: a mesh
// depends on the rounded sizes alone.
class PartMeshes {
  public:
    // Length and radius in steps.
    using Size = std::pair<std::uint64_t, std::uint64_t>;
    static Size size_of(const PartCapsule& capsule);
    // Builds the capsule's mesh if it is missing. Not for several threads at once.
    void add(const PartCapsule& capsule);
    // Null if no capsule of this size was added.
    const GripMesh* find(const PartCapsule& capsule) const;
    // The mesh's frame in the part's frame: the origin is the middle of the capsule's axis, +Y
    // along it.
    static Pose frame_of_mesh(const PartCapsule& capsule);

  private:
    std::map<Size, GripMesh> mesh_of_size_;
};

}  // namespace handhold
