#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/io/gltf_writer.hpp"

// What the writers of glTF share.
namespace handhold {

// Keys in the order of insertion: a file that people can read.
using GltfJson = nlohmann::ordered_json;

inline constexpr const char* k_emissive_strength = "KHR_materials_emissive_strength";

GltfJson gltf_material_json(const GltfMaterial& material);

// Collects views and accessors of one binary buffer; each call gives an accessor's number.
class GltfBufferWriter {
  public:
    int add_vertices(const std::vector<GltfVertex>& vertices, bool is_normal);
    int add_indices(const std::vector<std::uint32_t>& indices);
    // Four a vertex.
    int add_joints(std::span<const std::array<std::uint16_t, 4>> joints);
    int add_weights(std::span<const std::array<float, 4>> weights);
    // Column by column.
    int add_matrices(std::span<const std::array<float, 16>> matrices);

    void finish(GltfJson& root);
    const std::string& bytes() const { return bytes_; }

  private:
    int begin_view(int target);  // 0: none
    void end_view();
    int add_accessor(GltfJson accessor);

    std::string bytes_;
    GltfJson views_ = GltfJson::array();
    GltfJson accessors_ = GltfJson::array();
};

}  // namespace handhold
