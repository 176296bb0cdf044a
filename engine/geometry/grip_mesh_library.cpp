#include "engine/geometry/grip_mesh_library.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>

#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/geometry/grip_mesh_cache.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_no_mesh = k_no_triangle;

std::size_t work_of(const Shape& shape) {
    return shape.kind == ShapeKind::mesh ? shape.mesh->triangles.size() : 1000;
}

// Round shapes above this size would be tessellated too coarsely to grip, or into too many
// triangles.
bool is_too_large(const Shape& shape) {
    constexpr double k_largest_m = 64.0;
    const bool may_be_round = shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule ||
                              shape.kind == ShapeKind::cylinder ||
                              shape.kind == ShapeKind::compound;
    return may_be_round && bounding_radius(shape) > k_largest_m;
}

std::vector<ShapeId> all_of(const ShapeLibrary& shapes) {
    std::vector<ShapeId> all(shapes.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        all[i] = {i};
    }
    return all;
}

}  // namespace

GripMeshLibrary::SurfaceKey GripMeshLibrary::surface_key(const Shape& shape) {
    const auto address = [](const auto& pointer) {
        return static_cast<std::uint64_t>(std::bit_cast<std::uintptr_t>(pointer.get()));
    };
    SurfaceKey key = {static_cast<std::uint64_t>(shape.kind),
                      address(shape.hull) ^ address(shape.parts) ^ address(shape.mesh),
                      std::bit_cast<std::uint64_t>(shape.radius_m),
                      std::bit_cast<std::uint64_t>(shape.half_height_m)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        key[4 + axis] = std::bit_cast<std::uint64_t>(shape.half_m[i]);
        key[7 + axis] = std::bit_cast<std::uint64_t>(shape.scale[i]);
    }
    return key;
}

GripMeshLibrary::GripMeshLibrary(const ShapeLibrary& shapes, const GripMeshSettings& settings,
                                 const std::filesystem::path& cache_directory)
    : GripMeshLibrary(shapes, all_of(shapes), settings, cache_directory) {}

GripMeshLibrary::GripMeshLibrary(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
                                 const GripMeshSettings& settings,
                                 const std::filesystem::path& cache_directory) {
    add(shapes, wanted, settings, cache_directory);
}

void GripMeshLibrary::add(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
                          const GripMeshSettings& settings,
                          const std::filesystem::path& cache_directory) {
    mesh_of_shape_.resize(shapes.size(), k_no_mesh);
    const auto first = static_cast<std::uint32_t>(meshes_.size());
    std::vector<ShapeId> distinct;
    for (const ShapeId id : wanted) {
        if (is_too_large(shapes.at(id))) {
            continue;
        }
        const auto [found, is_new] = mesh_of_surface_.try_emplace(
            surface_key(shapes.at(id)), first + static_cast<std::uint32_t>(distinct.size()));
        if (is_new) {
            distinct.push_back(id);
        }
        mesh_of_shape_[id.index] = found->second;
    }
    meshes_.resize(first + distinct.size());
    std::vector<std::size_t> order(distinct.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return work_of(shapes.at(distinct[a])) > work_of(shapes.at(distinct[b]));
    });
    constexpr std::uint64_t k_passes = 2;  // contact and search detail
    WorkMeter& meter = work_meter();
    for (const ShapeId id : distinct) {
        meter.planned += k_passes * work_of(shapes.at(id));
    }
    auto build = [&](std::size_t i) {
        const std::size_t place = order[i];
        GripMesh& made = meshes_[first + place];
        made = cached_grip_mesh(shapes.at(distinct[place]), settings, cache_directory);
        // Adds the planned work that the build did not count: dropped triangles and meshes read
        // from the cache.
        const std::uint64_t planned = k_passes * work_of(shapes.at(distinct[place]));
        meter.done += planned - std::min<std::uint64_t>(
                                    planned, made.full_triangles + made.contact.triangles.size());
    };
    parallel_for(order.size(), build);
}

bool GripMeshLibrary::has(ShapeId shape) const {
    return shape.index < mesh_of_shape_.size() && mesh_of_shape_[shape.index] != k_no_mesh;
}

const GripMesh& GripMeshLibrary::at(ShapeId shape) const {
    HH_CHECK(has(shape), "no grip mesh was made for this shape", shape.index);
    return meshes_[mesh_of_shape_[shape.index]];
}

std::size_t GripMeshLibrary::memory_bytes() const {
    return std::accumulate(
        meshes_.begin(), meshes_.end(), std::size_t{0},
        [](std::size_t sum, const GripMesh& grip) { return sum + handhold::memory_bytes(grip); });
}

}  // namespace handhold
