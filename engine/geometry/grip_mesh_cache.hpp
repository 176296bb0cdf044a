#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/geometry/grip_mesh.hpp"

// Grip meshes on disk, named by what they were made of: making one takes seconds for a large level.
namespace handhold {

// Names the mesh's positions and triangles, all settings and the version of the format and of what
// builds: equal keys, equal grip meshes.
std::uint64_t grip_mesh_key(const Mesh& mesh, const GripMeshSettings& settings);

// As build_grip_mesh, by way of a file in `directory` that is made where it is missing; the file is
// ignored and made again where it is damaged, cut short, of another version or not ours. An empty
// path: no cache. A directory that cannot be made or written to costs time only. Several processes
// may share one: a file appears whole or not at all.
GripMesh cached_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings,
                          const std::filesystem::path& directory);
GripMesh cached_grip_mesh(const Shape& shape, const GripMeshSettings& settings,
                          const std::filesystem::path& directory);

// The file's bytes, and what they hold: nothing where a byte is not as it was written for this key.
std::string write_grip_mesh(const GripMesh& grip, std::uint64_t key);
std::optional<GripMesh> read_grip_mesh(std::string_view bytes, std::uint64_t key);

}  // namespace handhold
