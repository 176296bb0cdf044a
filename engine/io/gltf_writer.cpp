#include "engine/io/gltf_writer.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/io/glb.hpp"
#include "engine/io/gltf_buffer_writer.hpp"

namespace handhold {
namespace {

// One node per group, with a child node per surface.
void add_nodes(std::span<const GltfSurface> surfaces, GltfJson& root) {
    GltfJson nodes = GltfJson::array();
    GltfJson roots = GltfJson::array();
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (i == 0 || surfaces[i].group != surfaces[i - 1].group) {
            roots.push_back(nodes.size());
            nodes.push_back({{"name", surfaces[i].group}, {"children", GltfJson::array()}});
        }
        nodes[roots.back().get<std::size_t>()]["children"].push_back(nodes.size());
        nodes.push_back({{"name", surfaces[i].name}, {"mesh", i}});
    }
    root["scene"] = 0;
    root["scenes"] = GltfJson::array({{{"nodes", std::move(roots)}}});
    root["nodes"] = std::move(nodes);
}

}  // namespace

std::string write_glb(std::span<const GltfMaterial> materials,
                      std::span<const GltfSurface> surfaces) {
    GltfJson root;
    root["asset"] = {{"version", "2.0"}, {"generator", "handhold"}};
    root["extensionsUsed"] = {k_emissive_strength};
    add_nodes(surfaces, root);
    root["materials"] = GltfJson::array();
    for (const GltfMaterial& material : materials) {
        root["materials"].push_back(gltf_material_json(material));
    }
    GltfBufferWriter buffer;
    root["meshes"] = GltfJson::array();
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
              GltfJson::array({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                {"indices", indices},
                                {"material", surface.material}}})}});
    }
    buffer.finish(root);
    return join_glb(root.dump(), buffer.bytes());
}

}  // namespace handhold
