#include "systems/hand/shared/part_meshes.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// `length_m` with seven significant bits: within 0.8 % of the exact value.
double rounded_m(double length_m) {
    constexpr double k_steps = 128.0;  // steps in a power of two
    // Slightly more than one half, because some usual lengths lie exactly between two steps: when
    // such a length is measured again, rounding errors must not change its step.
    constexpr double k_up = 0.5 + 1e-6;
    int exponent = 0;
    const double mantissa = std::frexp(std::max(length_m, k_min_part_m), &exponent);
    return std::ldexp(std::floor(mantissa * k_steps + k_up) / k_steps, exponent);
}

}  // namespace

PartMeshes::Size PartMeshes::size_of(const PartCapsule& capsule) {
    return {rounded_m(capsule.end_bs.norm()), rounded_m(capsule.radius_m)};
}

void PartMeshes::drop_if_many(std::size_t held) {
    if (mesh_of_size_.size() > std::max(k_many_part_meshes, 2 * held)) {
        mesh_of_size_.clear();
    }
}

void PartMeshes::add(const PartCapsule& capsule) {
    const auto [length_m, radius_m] = size_of(capsule);
    if (mesh_of_size_.contains({length_m, radius_m})) {
        return;
    }
    Shape shape;
    shape.kind = ShapeKind::capsule;
    shape.half_height_m = 0.5 * length_m;
    shape.radius_m = radius_m;
    GripMeshSettings settings;
    // Skin; a finer mesh takes long to build within a frame. A small hand on a giant's part needs
    // no finer sectors than a hand on a usual part.
    settings.shape_tolerance_m = std::max(1e-3, radius_m / 200.0);
    mesh_of_size_.emplace(Size{length_m, radius_m}, build_grip_mesh(shape, settings));
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
