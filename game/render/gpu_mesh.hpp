#pragma once

#include <array>
#include <span>
#include <vector>

#include "game/render/gl_objects.hpp"
#include "game/render/render_frame.hpp"
#include "game/render/shading_mesh.hpp"

namespace handhold {

// A mesh on the graphics card. Included by sources of game/render only.
struct GpuMesh {
    GlVertexArray layout;
    GlBuffer vertices;
    GlBuffer indices;
    GLsizei index_count = 0;
    std::uint32_t vertices_named = 0;  // of a moving mesh: how many its triangles need
    GLsizei moving_index_count = 0;    // of a moving mesh: once it has vertices
    Vec3 center = Vec3::Zero();
    double radius_m = 0.0;
    Color color{};
};

inline std::array<float, 3> to_floats(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// The context that is to own it must be current, as for everything below.
GpuMesh make_gpu_mesh(const ShadingMesh& shading, const Color& color);
// New vertices for a moving mesh; `scratch` is only reused. Precondition: as many normals, and at
// least GpuMesh::vertices_named of them.
void move_gpu_mesh(std::span<const Vec3> positions, std::span<const Vec3> normals,
                   std::vector<float>& scratch, GpuMesh& gpu);

}  // namespace handhold
