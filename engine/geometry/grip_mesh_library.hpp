#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/geometry/grip_mesh.hpp"

namespace handhold {

inline constexpr double k_largest_round_m = 64.0;

// Grip meshes of a scene's shapes, built before the first frame. Equal shapes share one grip mesh:
// the same mesh at the same scale, the same hull or compound parts, or equal primitives. Round
// shapes with a bounding radius above k_largest_round_m have none. Immutable between calls of add,
// so any number of threads may read it.
class GripMeshLibrary {
  public:
    GripMeshLibrary() = default;
    // Builds the grip meshes of the shapes in `wanted`, or of all shapes. Uses the threads of
    // parallel.hpp; the result does not depend on their number. `cache_directory`: see
    // grip_mesh_cache.hpp.
    explicit GripMeshLibrary(const ShapeLibrary& shapes, const GripMeshSettings& settings = {},
                             const std::filesystem::path& cache_directory = {});
    GripMeshLibrary(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
                    const GripMeshSettings& settings = {},
                    const std::filesystem::path& cache_directory = {});

    // Builds the missing grip meshes of `wanted`. `shapes` must contain the shapes of earlier
    // calls, with the same ids.
    void add(const ShapeLibrary& shapes, std::span<const ShapeId> wanted,
             const GripMeshSettings& settings = {},
             const std::filesystem::path& cache_directory = {});

    // Takes a mesh that was built elsewhere, for instance on a loading thread. Replaces nothing: if
    // an equal surface has a mesh, that one is used.
    void insert(const ShapeLibrary& shapes, ShapeId shape, std::shared_ptr<const GripMesh> mesh);
    // Forgets a shape, and its mesh if no other shape has it. Call it before the shape is removed
    // from `shapes`. No effect on a shape without a mesh.
    void remove(const ShapeLibrary& shapes, ShapeId shape);

    // Precondition: has(shape).
    const GripMesh& at(ShapeId shape) const { return *shared_at(shape); }
    const std::shared_ptr<const GripMesh>& shared_at(ShapeId shape) const;
    bool has(ShapeId shape) const;
    std::size_t distinct_count() const { return mesh_of_surface_.size(); }
    std::size_t memory_bytes() const;

  private:
    // Equal for shapes with equal surfaces. Contains addresses, which are only compared for
    // equality: no result depends on their order.
    using SurfaceKey = std::array<std::uint64_t, 10>;
    static SurfaceKey surface_key(const Shape& shape);

    std::map<SurfaceKey, std::uint32_t> mesh_of_surface_;  // index into meshes_
    std::vector<std::uint32_t> mesh_of_shape_;  // indexed by ShapeId::index; k_no_triangle: no mesh
    struct Entry {
        std::shared_ptr<const GripMesh> mesh;  // null: unused
        std::uint32_t users = 0;               // number of shapes that use the mesh
    };
    std::vector<Entry> meshes_;
    std::vector<std::uint32_t> unused_;  // indices into meshes_
    std::uint32_t new_entry();
    void use(ShapeId shape, std::uint32_t mesh);
};

}  // namespace handhold
