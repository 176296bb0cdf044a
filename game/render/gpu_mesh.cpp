#include "game/render/gpu_mesh.hpp"

#include <array>

namespace handhold {
GpuMesh make_gpu_mesh(const ShadingMesh& shading, const Color& color) {
    GpuMesh gpu;
    gpu.center = shading.center;
    gpu.radius_m = shading.radius_m;
    gpu.color = color;
    gpu.index_count = static_cast<GLsizei>(shading.indices.size());
    gpu.moving_index_count = gpu.index_count;
    gpu.layout = make_vertex_array();
    gpu.vertices = make_buffer();
    gpu.indices = make_buffer();
    glBindVertexArray(gpu.layout);
    glBindBuffer(GL_ARRAY_BUFFER, gpu.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(shading.vertices.size() * sizeof(float)),
                 shading.vertices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gpu.indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(shading.indices.size() * sizeof(std::uint32_t)),
                 shading.indices.data(), GL_STATIC_DRAW);
    constexpr GLsizei k_stride = 6 * sizeof(float);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, k_stride, nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, k_stride,
                          // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL's way of an offset
                          reinterpret_cast<const void*>(3 * sizeof(float)));
    return gpu;
}

void move_gpu_mesh(std::span<const Vec3> positions, std::span<const Vec3> normals,
                   std::vector<float>& scratch, GpuMesh& gpu) {
    Vec3 low = positions.front();
    Vec3 high = low;
    for (const Vec3& position : positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    gpu.center = 0.5 * (low + high);
    gpu.radius_m = 0.5 * (high - low).norm();
    scratch.clear();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::array<float, 3> place = to_floats(positions[i] - gpu.center);
        const std::array<float, 3> normal = to_floats(normals[i]);
        scratch.insert(scratch.end(), place.begin(), place.end());
        scratch.insert(scratch.end(), normal.begin(), normal.end());
    }
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, gpu.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scratch.size() * sizeof(float)),
                 scratch.data(), GL_STREAM_DRAW);
    gpu.index_count = gpu.moving_index_count;
}

}  // namespace handhold
