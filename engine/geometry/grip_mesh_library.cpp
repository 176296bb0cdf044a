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

// True for round shapes above k_largest_round_m: they would be tessellated too coarsely to grip, or
// into too many triangles.
bool is_too_large(const Shape& shape) {
    const bool may_be_round = shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule ||
                              shape.kind == ShapeKind::cylinder ||
                              shape.kind == ShapeKind::compound;
    return may_be_round && bounding_radius(shape) > k_largest_round_m;
}

std::vector<ShapeId> all_of(const ShapeLibrary& shapes) {
    std::vector<ShapeId> all;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        if (shapes.has({i})) {
            all.push_back({i});
        }
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

void GripMeshLibrary::use(ShapeId shape, std::uint32_t mesh) {
    if (mesh_of_shape_[shape.index] == k_no_mesh) {
        mesh_of_shape_[shape.index] = mesh;
        ++meshes_[mesh].users;
    }
}

void GripMeshLibrary::add(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
                          const GripMeshSettings& settings,
                          const std::filesystem::path& cache_directory) {
    mesh_of_shape_.resize(shapes.size(), k_no_mesh);
    struct Missing {
        ShapeId shape;
        std::uint32_t mesh = 0;
    };
    std::vector<Missing> missing;
    for (const ShapeId id : wanted) {
        if (is_too_large(shapes.at(id))) {
            continue;
        }
        const auto [found, is_new] = mesh_of_surface_.try_emplace(surface_key(shapes.at(id)));
        if (is_new) {
            found->second = new_entry();
            missing.push_back({id, found->second});
        }
        use(id, found->second);
    }
    std::vector<std::size_t> order(missing.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return work_of(shapes.at(missing[a].shape)) > work_of(shapes.at(missing[b].shape));
    });
    constexpr std::uint64_t k_passes = 2;  // contact and search detail
    WorkMeter& meter = work_meter();
    for (const Missing& one : missing) {
        meter.planned += k_passes * work_of(shapes.at(one.shape));
    }
    auto build = [&](std::size_t i) {
        const Shape& shape = shapes.at(missing[order[i]].shape);
        const auto made =
            std::make_shared<const GripMesh>(cached_grip_mesh(shape, settings, cache_directory));
        meshes_[missing[order[i]].mesh].mesh = made;
        // Adds the work that was not counted during the build: triangles that were dropped or came
        // from the cache.
        const std::uint64_t planned = k_passes * work_of(shape);
        meter.done += planned - std::min<std::uint64_t>(
                                    planned, made->full_triangles + made->contact.triangles.size());
    };
    parallel_for(order.size(), build);
}

std::uint32_t GripMeshLibrary::new_entry() {
    if (unused_.empty()) {
        meshes_.emplace_back();
        return static_cast<std::uint32_t>(meshes_.size() - 1);
    }
    const std::uint32_t reused = unused_.back();
    unused_.pop_back();
    return reused;
}

void GripMeshLibrary::insert(const ShapeLibrary& shapes, ShapeId shape,
                             std::shared_ptr<const GripMesh> mesh) {
    mesh_of_shape_.resize(shapes.size(), k_no_mesh);
    const auto [found, is_new] = mesh_of_surface_.try_emplace(surface_key(shapes.at(shape)));
    if (is_new) {
        found->second = new_entry();
        meshes_[found->second].mesh = std::move(mesh);
    }
    use(shape, found->second);
}

void GripMeshLibrary::remove(const ShapeLibrary& shapes, ShapeId shape) {
    if (!has(shape)) {
        return;
    }
    const std::uint32_t mesh = mesh_of_shape_[shape.index];
    mesh_of_shape_[shape.index] = k_no_mesh;
    if (--meshes_[mesh].users == 0) {
        meshes_[mesh] = {};
        unused_.push_back(mesh);
        mesh_of_surface_.erase(surface_key(shapes.at(shape)));
    }
}

bool GripMeshLibrary::has(ShapeId shape) const {
    return shape.index < mesh_of_shape_.size() && mesh_of_shape_[shape.index] != k_no_mesh;
}

const std::shared_ptr<const GripMesh>& GripMeshLibrary::shared_at(ShapeId shape) const {
    HH_CHECK(has(shape), "no grip mesh was made for this shape", shape.index);
    return meshes_[mesh_of_shape_[shape.index]].mesh;
}

std::size_t GripMeshLibrary::memory_bytes() const {
    return std::accumulate(
        meshes_.begin(), meshes_.end(), std::size_t{0}, [](std::size_t sum, const Entry& entry) {
            return entry.mesh == nullptr ? sum : sum + handhold::memory_bytes(*entry.mesh);
        });
}

}  // namespace handhold
