#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// A mesh as the graphics card takes it: float positions about a centre of their own, one normal a
// vertex.
struct ShadingMesh {
    Vec3 center = Vec3::Zero();   // of the bounding box, in the mesh's frame
    double radius_m = 0.0;        // of the sphere about the centre that holds every vertex
    std::vector<float> vertices;  // position, normal: six a vertex
    std::vector<std::uint32_t> indices;
};

// Splits vertices where neighbouring triangles meet at more than 35 degrees. Vertices at bitwise
// equal positions count as one, and a neighbour of opposite winding counts as turned, so split and
// mixed-up meshes are smooth too; each normal follows its own triangle's winding. Triangles without
// area and with vertices that are not finite are dropped.
ShadingMesh make_shading_mesh(const Mesh& mesh);

}  // namespace handhold
