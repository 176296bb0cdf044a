#include "engine/io/gltf_scene.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace handhold::gltf {
namespace {

// Sets `roots` to the root nodes of the chosen scene. Leaves it without a value if there is no
// scene.
bool choose_roots(const Model& model, Refusal& refusal, std::optional<std::vector<int>>& roots,
                  std::string& place) {
    if (model.scenes.empty() && model.scene == k_none) {
        return true;
    }
    const int scene = std::max(model.scene, 0);
    if (!has_element(model.scenes, scene)) {
        return refusal.refuse_index("/scene", "scene", model.scenes.size(), scene);
    }
    roots = element(model.scenes, scene);
    place = pointer("scenes", scene) + "/nodes";
    return true;
}

constexpr std::uint64_t k_max_instances = std::uint64_t{1} << 20;

struct InstanceAttribute {
    const char* name;
    Elements elements;
    std::vector<float> values;  // empty if the node does not have it
};

Affine instance_frame(const std::array<InstanceAttribute, 3>& attributes, std::size_t i) {
    const auto value = [&](std::size_t attribute, std::size_t components, std::size_t k) {
        return static_cast<double>(attributes[attribute].values[components * i + k]);
    };
    Affine frame;
    if (!attributes[0].values.empty()) {
        frame.translation = Vec3(value(0, 3, 0), value(0, 3, 1), value(0, 3, 2));
    }
    if (!attributes[1].values.empty()) {
        const Quat rotation(value(1, 4, 3), value(1, 4, 0), value(1, 4, 1), value(1, 4, 2));
        frame.linear = rotation.normalized().toRotationMatrix();
    }
    if (!attributes[2].values.empty()) {
        const Vec3 scale(value(2, 3, 0), value(2, 3, 1), value(2, 3, 2));
        frame.linear = (frame.linear * scale.asDiagonal()).eval();
    }
    return frame;
}

}  // namespace

bool place_scene(const Model& model, Refusal& refusal, std::vector<PlacedNode>& placed) {
    std::optional<std::vector<int>> roots;
    std::string roots_place;
    if (!choose_roots(model, refusal, roots, roots_place)) {
        return false;
    }
    std::vector<FileNode> nodes;
    nodes.reserve(model.nodes.size());
    for (const Node& node : model.nodes) {
        nodes.push_back({node.local, node.children});
    }
    Result<std::vector<PlacedNode>> found = place_nodes(nodes, roots, roots_place, refusal.file());
    if (!found) {
        return refusal.refuse(found.error().place, found.error().expected);
    }
    placed = std::move(found.value());
    return true;
}

bool place_instances(const PlacedNode& placed, const Model& model, AccessorReader& reader,
                     Refusal& refusal, std::vector<Affine>& frames) {
    const Node& node = element(model.nodes, placed.node);
    frames.assign(1, placed.world);
    if (!node.instances || node.skin != k_none) {
        return true;
    }
    std::array<InstanceAttribute, 3> attributes = {{{"TRANSLATION", Elements::vectors, {}},
                                                    {"ROTATION", Elements::quaternions, {}},
                                                    {"SCALE", Elements::vectors, {}}}};
    const std::string place =
        pointer("nodes", placed.node) + "/extensions/EXT_mesh_gpu_instancing/attributes";
    std::optional<std::uint64_t> count;
    for (InstanceAttribute& attribute : attributes) {
        const auto found = node.instances->find(attribute.name);
        if (found == node.instances->end()) {
            continue;
        }
        const std::string attribute_place = place + "/" + attribute.name;
        if (!reader.check(found->second, attribute.elements, attribute_place)) {
            return false;
        }
        const std::uint64_t elements = element(model.accessors, found->second).count;
        if (elements != count.value_or(elements) || elements > k_max_instances) {
            return refusal.refuse(attribute_place,
                                  "expected equally many instances in every attribute, at most " +
                                      std::to_string(k_max_instances) + ", found " +
                                      std::to_string(elements));
        }
        count = elements;
        if (!reader.read_floats(found->second, attribute.elements, attribute_place,
                                attribute.values)) {
            return false;
        }
    }
    if (!count) {
        return refusal.refuse(place, "expected TRANSLATION, ROTATION or SCALE");
    }
    frames.clear();
    for (std::size_t i = 0; i < *count; ++i) {
        frames.push_back(placed.world * instance_frame(attributes, i));
        if (!frames.back().linear.allFinite() || !is_finite(frames.back().translation)) {
            return refusal.refuse(place, "expected finite transforms, found another at instance " +
                                             std::to_string(i));
        }
    }
    return true;
}

std::string note_line(const std::string& file, const std::string& note) {
    return printable(file) + ": " + printable(note);
}

}  // namespace handhold::gltf
