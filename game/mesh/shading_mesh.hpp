#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// A mesh prepared for the graphics card: float positions relative to a centre, one normal per
// vertex.
struct ShadingMesh {
    Vec3 center = Vec3::Zero();   // centre of the bounding box, in the mesh's frame
    double radius_m = 0.0;        // radius of the bounding sphere around the centre
    std::vector<float> vertices;  // position, normal: six floats per vertex
    std::vector<std::uint32_t> indices;
};

// Splits vertices where neighbouring triangles meet at more than 35 degrees. Vertices at bitwise
// equal positions count as one, and a neighbour of opposite winding counts as flipped. Meshes with
// split vertices or mixed winding are therefore smooth too. Each normal follows its own triangle's
// winding. Drops triangles without area or with vertices that are not finite.
ShadingMesh make_shading_mesh(const Mesh& mesh);

}  // namespace handhold
