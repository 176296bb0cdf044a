#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/geometry/grip_mesh.hpp"

// Disk cache of grip meshes, because building one takes seconds for a large level. The key is a
// hash of the input.
namespace handhold {

// Hash of positions, triangles, settings, format version and build version. Equal keys mean equal
// grip meshes.
std::uint64_t grip_mesh_key(const Mesh& mesh, const GripMeshSettings& settings);

// Returns the result of build_grip_mesh, cached in a file in `directory`, which is created if
// missing. A damaged, truncated, outdated or foreign file is ignored and replaced. An empty path
// disables the cache. If the directory is not writable, the mesh is built on every call. Several
// processes may use one directory: a file appears complete or not at all.
GripMesh cached_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings,
                          const std::filesystem::path& directory);
GripMesh cached_grip_mesh(const Shape& shape, const GripMeshSettings& settings,
                          const std::filesystem::path& directory);

// Encodes and decodes a cache file. read_grip_mesh returns nullopt unless every byte is as written
// for `key`.
std::string write_grip_mesh(const GripMesh& grip, std::uint64_t key);
std::optional<GripMesh> read_grip_mesh(std::string_view bytes, std::uint64_t key);

}  // namespace handhold
