#include "engine/io/gltf_skin_writer.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/io/glb.hpp"
#include "engine/io/gltf_buffer_writer.hpp"

namespace handhold {
namespace {

GltfJson posed_node(const std::string& name, const Pose& pose) {
    const Quat& turn = pose.rotation;
    return {{"name", name},
            {"translation", {pose.position.x(), pose.position.y(), pose.position.z()}},
            {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}};
}

void check_surface(std::size_t materials, std::size_t vertices, std::size_t material,
                   const std::vector<std::uint32_t>& indices) {
    HH_CHECK(!indices.empty() && indices.size() % 3 == 0, "a surface has triangles",
             indices.size());
    HH_CHECK(*std::max_element(indices.begin(), indices.end()) < vertices, "no such vertex",
             vertices);
    HH_CHECK(material < materials, "no such material", material);
}

void check_skin(std::size_t materials, const GltfSkin& skin) {
    HH_CHECK(!skin.joints.empty() && skin.joints.size() <= k_max_skin_joints, "joints",
             skin.joints.size());
    HH_CHECK(!skin.surfaces.empty(), "a skin has surfaces", 0);
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        HH_CHECK(skin.joints[i].parent < static_cast<std::int32_t>(i), "parents come first", i);
    }
    for (const GltfSkinSurface& surface : skin.surfaces) {
        check_surface(materials, surface.vertices.size(), surface.material, surface.indices);
        HH_CHECK(surface.weights.size() == surface.vertices.size(), "weights by vertex",
                 surface.weights.size());
        for (const SkinWeights& weights : surface.weights) {
            for (const std::uint16_t joint : weights.joint) {
                HH_CHECK(joint < skin.joints.size(), "no such joint", joint);
            }
        }
    }
}

// Node 0 is the skin's root, and node 1 its mesh. Joint i is node i + 2.
void add_nodes(const GltfSkin& skin, GltfJson& root) {
    constexpr std::size_t k_first_joint = 2;
    GltfJson nodes = GltfJson::array();
    nodes.push_back({{"name", skin.name}, {"children", {1}}});
    nodes.push_back({{"name", skin.name + "_mesh"}, {"mesh", 0}, {"skin", 0}});
    GltfJson joints = GltfJson::array();
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const SkinJoint& joint = skin.joints[i];
        Pose local = joint.bind_ms;
        std::size_t parent = 0;
        if (joint.parent >= 0) {
            const auto above = static_cast<std::size_t>(joint.parent);
            local = inverse(skin.joints[above].bind_ms) * joint.bind_ms;
            parent = above + k_first_joint;
        }
        GltfJson node = posed_node(joint.name, local);
        for (const auto& [name, numbers] : joint.numbers) {
            node["extras"][name] = numbers;
        }
        nodes[parent]["children"].push_back(i + k_first_joint);
        nodes.push_back(std::move(node));
        joints.push_back(i + k_first_joint);
    }
    root["scene"] = 0;
    root["scenes"] = GltfJson::array({{{"nodes", {0}}}});
    root["nodes"] = std::move(nodes);
    root["skins"] = GltfJson::array({{{"name", skin.name}, {"joints", std::move(joints)}}});
}

std::array<float, 16> inverse_bind(const Pose& bind) {
    const Pose to_joint = inverse(bind);
    const Mat3 turn = to_joint.rotation.toRotationMatrix();
    std::array<float, 16> matrix = {};
    for (Eigen::Index column = 0; column < 3; ++column) {
        for (Eigen::Index row = 0; row < 3; ++row) {
            matrix[static_cast<std::size_t>(4 * column + row)] =
                static_cast<float>(turn(row, column));
        }
        matrix[static_cast<std::size_t>(12 + column)] =
            static_cast<float>(to_joint.position[column]);
    }
    matrix[15] = 1.0F;
    return matrix;
}

void add_object(const GltfObject& object, std::size_t materials, GltfBufferWriter& buffer,
                GltfJson& root) {
    GltfJson& nodes = root["nodes"];
    const std::size_t own = nodes.size();
    nodes.push_back(posed_node(object.name, object.pose_ms));
    root["scenes"][0]["nodes"].push_back(own);
    for (const auto& [name, numbers] : object.numbers) {
        nodes[own]["extras"][name] = numbers;
    }
    for (const GltfSurface& surface : object.surfaces) {
        check_surface(materials, surface.vertices.size(), surface.material, surface.indices);
        const int positions = buffer.add_vertices(surface.vertices, false);
        const int normals = buffer.add_vertices(surface.vertices, true);
        const int indices = buffer.add_indices(surface.indices);
        nodes[own]["children"].push_back(nodes.size());
        nodes.push_back({{"name", surface.name}, {"mesh", root["meshes"].size()}});
        root["meshes"].push_back(
            {{"name", surface.name},
             {"primitives",
              GltfJson::array({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                {"indices", indices},
                                {"material", surface.material}}})}});
    }
}

}  // namespace

std::string write_skinned_glb(std::span<const GltfMaterial> materials, const GltfSkin& skin,
                              std::span<const GltfObject> objects) {
    check_skin(materials.size(), skin);
    GltfJson root;
    root["asset"] = {{"version", "2.0"}, {"generator", "handhold"}};
    root["extensionsUsed"] = {k_emissive_strength};
    add_nodes(skin, root);
    root["materials"] = GltfJson::array();
    for (const GltfMaterial& material : materials) {
        root["materials"].push_back(gltf_material_json(material));
    }
    GltfBufferWriter buffer;
    GltfJson primitives = GltfJson::array();
    for (const GltfSkinSurface& surface : skin.surfaces) {
        std::vector<std::array<std::uint16_t, 4>> joints;
        std::vector<std::array<float, 4>> weights;
        for (const SkinWeights& of_vertex : surface.weights) {
            joints.push_back(of_vertex.joint);
            weights.push_back(of_vertex.weight);
        }
        GltfJson attributes;
        attributes["POSITION"] = buffer.add_vertices(surface.vertices, false);
        attributes["NORMAL"] = buffer.add_vertices(surface.vertices, true);
        attributes["JOINTS_0"] = buffer.add_joints(joints);
        attributes["WEIGHTS_0"] = buffer.add_weights(weights);
        primitives.push_back({{"attributes", std::move(attributes)},
                              {"indices", buffer.add_indices(surface.indices)},
                              {"material", surface.material}});
    }
    root["meshes"] = GltfJson::array({{{"name", skin.name}, {"primitives", primitives}}});
    std::vector<std::array<float, 16>> binds;
    for (const SkinJoint& joint : skin.joints) {
        binds.push_back(inverse_bind(joint.bind_ms));
    }
    root["skins"][0]["inverseBindMatrices"] = buffer.add_matrices(binds);
    for (const GltfObject& object : objects) {
        add_object(object, materials.size(), buffer, root);
    }
    buffer.finish(root);
    return join_glb(root.dump(), buffer.bytes());
}

}  // namespace handhold
