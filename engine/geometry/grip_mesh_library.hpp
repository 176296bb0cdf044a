#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

// The grip mesh of each shape of a scene, made once before the first frame. Shapes that are equal
// share one: a mesh at one scale, a hull or the parts of a compound held in common, primitives of
// one size. Round shapes that reach farther than 64 m have none. Read only between calls of add:
// any number of threads may ask.
class GripMeshLibrary {
  public:
    GripMeshLibrary() = default;
    // Of the shapes in `wanted` only, or of all of them. Splits the work over the threads of
    // parallel.hpp; the result does not depend on how many. `cache_directory`: grip_mesh_cache.hpp.
    explicit GripMeshLibrary(const ShapeLibrary& shapes, const GripMeshSettings& settings = {},
                             const std::filesystem::path& cache_directory = {});
    GripMeshLibrary(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
                    const GripMeshSettings& settings = {},
                    const std::filesystem::path& cache_directory = {});

    // Makes what is missing of `wanted`; what was made before stays as it is. The shapes are those
    // of earlier calls and more.
    void add(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
             const GripMeshSettings& settings = {},
             const std::filesystem::path& cache_directory = {});

    // Precondition: one of the shapes it was made for.
    const GripMesh& at(ShapeId shape) const;
    bool has(ShapeId shape) const;
    std::size_t distinct_count() const { return meshes_.size(); }
    std::size_t memory_bytes() const;

  private:
    // Equal where two shapes have one surface. Addresses only tell shapes apart: no order follows
    // them.
    using SurfaceKey = std::array<std::uint64_t, 10>;
    static SurfaceKey surface_key(const Shape& shape);

    std::map<SurfaceKey, std::uint32_t> known_;  // to meshes_
    std::vector<std::uint32_t> mesh_of_shape_;   // by ShapeId::index; k_no_triangle: none
    std::vector<GripMesh> meshes_;
};

}  // namespace handhold
