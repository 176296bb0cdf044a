#include "engine/io/gltf_buffer_writer.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/io/glb.hpp"

namespace handhold {
namespace {

constexpr int k_float = 5126;
constexpr int k_unsigned_int = 5125;
constexpr int k_unsigned_short = 5123;
constexpr int k_array_buffer = 34962;
constexpr int k_element_array_buffer = 34963;

void append_floats(std::string& bytes, std::span<const float> values) {
    for (const float value : values) {
        append_u32(bytes, std::bit_cast<std::uint32_t>(value));
    }
}

}  // namespace

GltfJson gltf_material_json(const GltfMaterial& material) {
    GltfJson json;
    json["name"] = material.name;
    json["pbrMetallicRoughness"] = {
        {"baseColorFactor",
         {material.color[0], material.color[1], material.color[2], material.opacity}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", 1.0F - material.gloss}};
    if (material.opacity < 1.0F) {
        json["alphaMode"] = "BLEND";
        json["doubleSided"] = true;
    }
    if (material.emissive > 0.0F) {
        json["emissiveFactor"] = {material.color[0], material.color[1], material.color[2]};
        json["extensions"][k_emissive_strength]["emissiveStrength"] = material.emissive;
    }
    return json;
}

int GltfBufferWriter::add_vertices(const std::vector<GltfVertex>& vertices, bool is_normal) {
    const int view = begin_view(k_array_buffer);
    std::array<float, 3> low = vertices.front().position;
    std::array<float, 3> high = low;
    for (const GltfVertex& vertex : vertices) {
        append_floats(bytes_, is_normal ? vertex.normal : vertex.position);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], vertex.position[axis]);
            high[axis] = std::max(high[axis], vertex.position[axis]);
        }
    }
    end_view();
    GltfJson accessor = {{"bufferView", view},
                         {"componentType", k_float},
                         {"count", vertices.size()},
                         {"type", "VEC3"}};
    if (!is_normal) {
        accessor["min"] = low;
        accessor["max"] = high;
    }
    return add_accessor(std::move(accessor));
}

int GltfBufferWriter::add_indices(const std::vector<std::uint32_t>& indices) {
    const int view = begin_view(k_element_array_buffer);
    for (const std::uint32_t index : indices) {
        append_u32(bytes_, index);
    }
    end_view();
    return add_accessor({{"bufferView", view},
                         {"componentType", k_unsigned_int},
                         {"count", indices.size()},
                         {"type", "SCALAR"}});
}

int GltfBufferWriter::add_joints(std::span<const std::array<std::uint16_t, 4>> joints) {
    const int view = begin_view(k_array_buffer);
    for (const std::array<std::uint16_t, 4>& four : joints) {
        append_u32(bytes_, four[0] | (std::uint32_t{four[1]} << 16U));
        append_u32(bytes_, four[2] | (std::uint32_t{four[3]} << 16U));
    }
    end_view();
    return add_accessor({{"bufferView", view},
                         {"componentType", k_unsigned_short},
                         {"count", joints.size()},
                         {"type", "VEC4"}});
}

int GltfBufferWriter::add_weights(std::span<const std::array<float, 4>> weights) {
    const int view = begin_view(k_array_buffer);
    for (const std::array<float, 4>& four : weights) {
        append_floats(bytes_, four);
    }
    end_view();
    return add_accessor({{"bufferView", view},
                         {"componentType", k_float},
                         {"count", weights.size()},
                         {"type", "VEC4"}});
}

int GltfBufferWriter::add_matrices(std::span<const std::array<float, 16>> matrices) {
    const int view = begin_view(0);
    for (const std::array<float, 16>& matrix : matrices) {
        append_floats(bytes_, matrix);
    }
    end_view();
    return add_accessor({{"bufferView", view},
                         {"componentType", k_float},
                         {"count", matrices.size()},
                         {"type", "MAT4"}});
}

void GltfBufferWriter::finish(GltfJson& root) {
    root["accessors"] = std::move(accessors_);
    root["bufferViews"] = std::move(views_);
    root["buffers"] = GltfJson::array({{{"byteLength", bytes_.size()}}});
}

int GltfBufferWriter::begin_view(int target) {
    GltfJson view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 0}};
    if (target != 0) {
        view["target"] = target;
    }
    views_.push_back(std::move(view));
    return static_cast<int>(views_.size()) - 1;
}

void GltfBufferWriter::end_view() {
    GltfJson& view = views_.back();
    view["byteLength"] = bytes_.size() - view["byteOffset"].get<std::size_t>();
}

int GltfBufferWriter::add_accessor(GltfJson accessor) {
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
}

}  // namespace handhold
