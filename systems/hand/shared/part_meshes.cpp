#include "systems/hand/shared/part_meshes.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {}  // namespace

PartMeshes::Size PartMeshes::size_of(const PartCapsule& capsule) {
    constexpr double k_most_steps = 1e4;
    // Slightly more than one half, because some usual lengths lie exactly between two steps: when
    // such a length is measured again, rounding errors must not change its step.
    constexpr double k_up = 0.5 + 1e-6;
    const auto steps = [&](double length_m, double step_m) {
        const double exact = std::min(length_m / step_m, k_most_steps);
        return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(exact + k_up));
    };
    return {steps(capsule.end_bs.norm(), k_length_step_m),
            steps(capsule.radius_m, k_radius_step_m)};
}

void PartMeshes::add(const PartCapsule& capsule) {
    const Size size = size_of(capsule);
    if (mesh_of_size_.contains(size)) {
        return;
    }
    Shape shape;
    shape.kind = ShapeKind::capsule;
    shape.half_height_m = 0.5 * k_length_step_m * static_cast<double>(size.first);
    shape.radius_m = k_radius_step_m * static_cast<double>(size.second);
    GripMeshSettings settings;
    settings.shape_tolerance_m = 1e-3;  // skin; a finer mesh takes long to build within a frame
    mesh_of_size_.emplace(size, build_grip_mesh(shape, settings));
}

const GripMesh* PartMeshes::find(const PartCapsule& capsule) const {
    const auto found = mesh_of_size_.find(size_of(capsule));
    return found != mesh_of_size_.end() ? &found->second : nullptr;
}

Pose PartMeshes::frame_of_mesh(const PartCapsule& capsule) {
    // Bones lie along Y or Z of their part. The mesh's capsule lies along Y.
    const bool along_z = std::abs(capsule.end_bs.z()) > std::abs(capsule.end_bs.y());
    return {0.5 * capsule.end_bs,
            along_z ? rotation_about(Vec3::UnitX(), k_half_pi) : Quat::Identity()};
}

}  // namespace handhold
