#pragma once

#include <array>
#include <span>
#include <vector>

#include "game/mesh/render_frame.hpp"
#include "game/mesh/shading_mesh.hpp"
#include "game/render/gl_objects.hpp"

namespace handhold {

// A mesh on the graphics card. Only included by sources of game/render.
struct GpuMesh {
    GlVertexArray layout;
    GlBuffer vertices;
    GlBuffer indices;
    GLsizei index_count = 0;
    std::uint32_t vertices_named = 0;  // moving mesh: highest vertex index of its triangles + 1
    GLsizei moving_index_count = 0;    // moving mesh: index count once it has vertices
    Vec3 center = Vec3::Zero();
    double radius_m = 0.0;
    Color color{};
};

inline std::array<float, 3> to_floats(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Precondition of both functions: the OpenGL context that owns the mesh is current.
GpuMesh make_gpu_mesh(const ShadingMesh& shading, const Color& color);
// Sets the vertices of a moving mesh. `scratch` is only reused memory. Precondition: as many
// normals as positions, at least GpuMesh::vertices_named.
void move_gpu_mesh(std::span<const Vec3> positions, std::span<const Vec3> normals,
                   std::vector<float>& scratch, GpuMesh& gpu);

}  // namespace handhold
