#include "engine/io/gltf_writer.hpp"

#include <algorithm>
#include <bit>

#include <nlohmann/json.hpp>

#include "engine/core/check.hpp"
#include "engine/io/gltf_document.hpp"

namespace handhold {
namespace {

// Keys in the order of insertion: a file that people can read.
using Json = nlohmann::ordered_json;

constexpr int k_float = 5126;
constexpr int k_unsigned_int = 5125;
constexpr int k_array_buffer = 34962;
constexpr int k_element_array_buffer = 34963;
constexpr const char* k_emissive_strength = "KHR_materials_emissive_strength";

void append_u32(std::string& bytes, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>((value >> shift) & 0xFFU);
    }
}
void append_floats(std::string& bytes, const std::array<float, 3>& values) {
    for (const float value : values) {
        append_u32(bytes, std::bit_cast<std::uint32_t>(value));
    }
}

Json material_json(const GltfMaterial& material) {
    Json json;
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

// Collects views and accessors of one binary buffer.
class BufferWriter {
  public:
    int add_vertices(const std::vector<GltfVertex>& vertices, bool is_normal) {
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
        Json accessor = {{"bufferView", view},
                         {"componentType", k_float},
                         {"count", vertices.size()},
                         {"type", "VEC3"}};
        if (!is_normal) {
            accessor["min"] = low;
            accessor["max"] = high;
        }
        return add_accessor(std::move(accessor));
    }

    int add_indices(const std::vector<std::uint32_t>& indices) {
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

    void finish(Json& root) {
        root["accessors"] = std::move(accessors_);
        root["bufferViews"] = std::move(views_);
        root["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    }
    const std::string& bytes() const { return bytes_; }

  private:
    int begin_view(int target) {
        views_.push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 0}, {"target", target}});
        return static_cast<int>(views_.size()) - 1;
    }
    void end_view() {
        Json& view = views_.back();
        view["byteLength"] = bytes_.size() - view["byteOffset"].get<std::size_t>();
    }
    int add_accessor(Json accessor) {
        accessors_.push_back(std::move(accessor));
        return static_cast<int>(accessors_.size()) - 1;
    }

    std::string bytes_;
    Json views_ = Json::array();
    Json accessors_ = Json::array();
};

// Nodes: one a group, above those of its surfaces.
void add_nodes(std::span<const GltfSurface> surfaces, Json& root) {
    Json nodes = Json::array();
    Json roots = Json::array();
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (i == 0 || surfaces[i].group != surfaces[i - 1].group) {
            roots.push_back(nodes.size());
            nodes.push_back({{"name", surfaces[i].group}, {"children", Json::array()}});
        }
        nodes[roots.back().get<std::size_t>()]["children"].push_back(nodes.size());
        nodes.push_back({{"name", surfaces[i].name}, {"mesh", i}});
    }
    root["scene"] = 0;
    root["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
    root["nodes"] = std::move(nodes);
}

}  // namespace

std::string write_glb(std::span<const GltfMaterial> materials,
                      std::span<const GltfSurface> surfaces) {
    Json root;
    root["asset"] = {{"version", "2.0"}, {"generator", "handhold"}};
    root["extensionsUsed"] = {k_emissive_strength};
    add_nodes(surfaces, root);
    root["materials"] = Json::array();
    for (const GltfMaterial& material : materials) {
        root["materials"].push_back(material_json(material));
    }
    BufferWriter buffer;
    root["meshes"] = Json::array();
    for (const GltfSurface& surface : surfaces) {
        HH_CHECK(!surface.indices.empty() && surface.indices.size() % 3 == 0,
                 "a surface has triangles", surface.indices.size());
        HH_CHECK(*std::max_element(surface.indices.begin(), surface.indices.end()) <
                     surface.vertices.size(),
                 "no such vertex", surface.vertices.size());
        HH_CHECK(surface.material < materials.size(), "no such material", surface.material);
        const int positions = buffer.add_vertices(surface.vertices, false);
        const int normals = buffer.add_vertices(surface.vertices, true);
        const int indices = buffer.add_indices(surface.indices);
        root["meshes"].push_back(
            {{"name", surface.name},
             {"primitives",
              Json::array({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                            {"indices", indices},
                            {"material", surface.material}}})}});
    }
    buffer.finish(root);
    return join_glb(root.dump(), buffer.bytes());
}

}  // namespace handhold
