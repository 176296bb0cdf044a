#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// A vertex index in the type that triangles use.
inline std::uint32_t index_of(std::size_t vertex) { return static_cast<std::uint32_t>(vertex); }

// Appends a copy of `part`, transformed by `at`. `into` keeps its name and colour.
void append(Mesh& into, const Mesh& part, const Pose& at = {});
// Mirrors through x = 0 and reverses the winding, so that the outside stays outside.
void mirror_x(Mesh& mesh);
// Scales each axis; factors must be above 0.
void stretch(Mesh& mesh, const Vec3& factors);
// Merges vertices at bitwise equal positions, in order of first use, and drops unused vertices.
void weld(Mesh& mesh);

}  // namespace handhold
