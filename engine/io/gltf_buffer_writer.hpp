#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/io/gltf_writer.hpp"

// Used by all glTF writers.
namespace handhold {

// Keeps keys in the order of insertion, so that files are easier to read.
using GltfJson = nlohmann::ordered_json;

inline constexpr const char* k_emissive_strength = "KHR_materials_emissive_strength";

GltfJson gltf_material_json(const GltfMaterial& material);

// Collects the views and accessors of one binary buffer. Each add_ function returns the index of
// its accessor.
class GltfBufferWriter {
  public:
    int add_vertices(const std::vector<GltfVertex>& vertices, bool is_normal);
    int add_indices(const std::vector<std::uint32_t>& indices);
    // Four joints or weights per vertex.
    int add_joints(std::span<const std::array<std::uint16_t, 4>> joints);
    int add_weights(std::span<const std::array<float, 4>> weights);
    // Column-major.
    int add_matrices(std::span<const std::array<float, 16>> matrices);

    // Writes accessors, views and the buffer into `root`. Call it last.
    void finish(GltfJson& root);
    const std::string& bytes() const { return bytes_; }

  private:
    int begin_view(int target);  // 0: no target
    void end_view();
    int add_accessor(GltfJson accessor);

    std::string bytes_;
    GltfJson views_ = GltfJson::array();
    GltfJson accessors_ = GltfJson::array();
};

}  // namespace handhold
