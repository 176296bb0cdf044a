#include "engine/io/gltf_nodes.hpp"

#include "engine/io/gltf_model.hpp"
#include "engine/io/text_file.hpp"

namespace handhold {

Result<std::vector<GltfNode>> parse_gltf_nodes(std::string_view bytes,
                                               const std::filesystem::path& path) {
    const Result<std::string> glb = extract_geometry_glb(bytes, path.string(), GltfUse::skinned);
    if (!glb) {
        return glb.error();
    }
    const Result<tinygltf::Model> model = parse_gltf_model(glb.value(), path);
    if (!model) {
        return model.error();
    }
    GltfModelReader reader(model.value(), path.string());
    std::vector<PlacedNode> placed;
    if (!reader.place_scene(placed)) {
        return reader.error();
    }
    std::vector<GltfNode> nodes;
    std::map<int, std::size_t> parent_of;  // by the node's number
    for (const PlacedNode& node : placed) {
        const tinygltf::Node& from = model.value().nodes[static_cast<std::size_t>(node.node)];
        const auto parent = parent_of.find(node.node);
        for (const int child : from.children) {
            parent_of.emplace(child, nodes.size());
        }
        nodes.push_back({from.name, rigid_part(node.world), read_gltf_numbers(from.extras),
                         gltf_pointer("nodes", node.node),
                         parent != parent_of.end() ? std::optional(parent->second) : std::nullopt});
    }
    return nodes;
}

Result<std::vector<GltfNode>> load_gltf_nodes(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return bytes.error();
    }
    return parse_gltf_nodes(bytes.value(), path);
}

}  // namespace handhold
