#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// As triangles name a vertex.
inline std::uint32_t index_of(std::size_t vertex) { return static_cast<std::uint32_t>(vertex); }

// Adds a copy of `part`, moved by `at`, to `into`; name and colour of `into` stay.
void append(Mesh& into, const Mesh& part, const Pose& at = {});
// Through the plane x = 0; the winding is turned so that outside stays outside.
void mirror_x(Mesh& mesh);
// Scales each axis; factors above 0.
void stretch(Mesh& mesh, const Vec3& factors);
// Makes vertices at bitwise equal positions one, in order of first use, and drops what no triangle
// uses.
void weld(Mesh& mesh);

}  // namespace handhold
