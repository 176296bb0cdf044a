#include "engine/io/gltf_nodes.hpp"

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_scene.hpp"

namespace handhold {

Result<std::vector<GltfNode>> parse_gltf_nodes(std::string_view bytes,
                                               const std::filesystem::path& path) {
    const Result<gltf::Model> model = gltf::parse_model(bytes, path.string());
    if (!model) {
        return model.error();
    }
    gltf::Refusal refusal(path.string());
    std::vector<PlacedNode> placed;
    if (!gltf::place_scene(model.value(), refusal, placed)) {
        return refusal.error();
    }
    std::vector<GltfNode> nodes;
    // Maps a child's index in the file to its parent's index in `nodes`.
    std::map<int, std::size_t> parent_of;
    for (const PlacedNode& node : placed) {
        const gltf::Node& from = gltf::element(model.value().nodes, node.node);
        const auto parent = parent_of.find(node.node);
        for (const int child : from.children) {
            parent_of.emplace(child, nodes.size());
        }
        nodes.push_back({from.name, rigid_part(node.world), from.numbers,
                         gltf::pointer("nodes", node.node),
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
