#include "engine/io/gltf_skin.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "engine/io/gltf_model.hpp"
#include "engine/io/text_file.hpp"
#include "engine/io/triangle_list.hpp"

namespace handhold {
namespace {

// The first error stops it.
class SkinReader {
  public:
    SkinReader(const tinygltf::Model& model, std::string file)
        : model_(model), reader_(model, file) {
        skin_.file = std::move(file);
    }

    Result<SkinnedMesh> read() {
        if (!reader_.place_scene(placed_) || !choose_skin() || !read_joints() || !read_binds() ||
            !read_meshes()) {
            return reader_.error();
        }
        finish_normals();
        return std::move(skin_);
    }

  private:
    struct VertexViews {
        AccessorView positions, normals, joints, weights;
        bool has_normals = false;
    };

    bool refuse(std::string place, std::string expected) {
        return reader_.refuse(std::move(place), std::move(expected));
    }
    bool choose_skin();
    bool read_joints();
    void find_parents(const std::map<int, std::int32_t>& joint_of_node);
    bool read_binds();
    bool read_meshes();
    bool read_primitive(const tinygltf::Primitive& primitive, const std::string& place);
    bool view_vertices(const tinygltf::Primitive& primitive, const std::string& place,
                       VertexViews& views);
    bool append_vertex(const VertexViews& views, std::size_t i, const std::string& place);
    bool append_weights(const VertexViews& views, std::size_t i, const std::string& place);
    void finish_normals();

    const tinygltf::Model& model_;
    GltfModelReader reader_;
    SkinnedMesh skin_;
    int skin_index_ = -1;
    std::vector<PlacedNode> placed_;
    std::vector<Affine> to_scene_;  // by joint: from the mesh's bind space
    std::vector<std::uint32_t> indices_;
};

bool SkinReader::choose_skin() {
    for (const PlacedNode& placed : placed_) {
        const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.node)];
        if (node.mesh == -1 || node.skin == -1) {
            continue;
        }
        const std::string place = gltf_pointer("nodes", placed.node) + "/skin";
        if (!is_gltf_index(node.skin, model_.skins.size())) {
            return reader_.refuse_index(place, "skin", model_.skins.size(), node.skin);
        }
        if (skin_index_ != -1 && skin_index_ != node.skin) {
            return refuse(place, "expected one skin, found a second one");
        }
        skin_index_ = node.skin;
    }
    return skin_index_ != -1 || refuse("/nodes", "expected a mesh with a skin");
}

bool SkinReader::read_joints() {
    const std::vector<int>& joints = model_.skins[static_cast<std::size_t>(skin_index_)].joints;
    const std::string place = gltf_pointer("skins", skin_index_) + "/joints";
    if (joints.empty() || joints.size() > k_max_skin_joints) {
        return refuse(place, "expected 1 to " + std::to_string(k_max_skin_joints) +
                                 " joints, found " + std::to_string(joints.size()));
    }
    std::map<int, const PlacedNode*> by_node;
    for (const PlacedNode& placed : placed_) {
        by_node[placed.node] = &placed;
    }
    std::map<int, std::int32_t> joint_of_node;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::string joint_place = place + "/" + std::to_string(i);
        const auto node = by_node.find(joints[i]);
        if (node == by_node.end()) {
            return refuse(joint_place,
                          "expected a node of the scene, found " + std::to_string(joints[i]));
        }
        if (!joint_of_node.emplace(joints[i], static_cast<std::int32_t>(i)).second) {
            return refuse(joint_place, "expected every joint once");
        }
        const std::optional<Pose> pose = rigid_part(node->second->world);
        if (!pose || pose->position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
            return refuse(gltf_pointer("nodes", joints[i]),
                          "expected a joint that is turned, moved and evenly scaled at most");
        }
        const tinygltf::Node& file_node = model_.nodes[static_cast<std::size_t>(joints[i])];
        skin_.joints.push_back({file_node.name, -1, *pose, read_gltf_numbers(file_node.extras)});
        to_scene_.push_back(node->second->world);
    }
    find_parents(joint_of_node);
    return true;
}

void SkinReader::find_parents(const std::map<int, std::int32_t>& joint_of_node) {
    std::map<int, std::int32_t> joint_above;    // by node
    for (const PlacedNode& placed : placed_) {  // parents first
        const auto self = joint_of_node.find(placed.node);
        const auto above = joint_above.find(placed.node);
        std::int32_t joint = above == joint_above.end() ? -1 : above->second;
        if (self != joint_of_node.end()) {
            skin_.joints[static_cast<std::size_t>(self->second)].parent = joint;
            joint = self->second;
        }
        for (const int child : model_.nodes[static_cast<std::size_t>(placed.node)].children) {
            joint_above[child] = joint;
        }
    }
}

bool SkinReader::read_binds() {
    const int accessor = model_.skins[static_cast<std::size_t>(skin_index_)].inverseBindMatrices;
    if (accessor == -1) {  // then they are identities (specification, 3.7.3.1)
        return true;
    }
    const std::string place = gltf_pointer("skins", skin_index_) + "/inverseBindMatrices";
    AccessorView view;
    if (!reader_.view_accessor(accessor, GltfElements::matrices, place, view)) {
        return false;
    }
    if (view.count < to_scene_.size()) {
        return refuse(place, "expected a matrix for each of the " +
                                 std::to_string(to_scene_.size()) + " joints, found " +
                                 std::to_string(view.count));
    }
    for (std::size_t i = 0; i < to_scene_.size(); ++i) {
        Affine inverse_bind;
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                inverse_bind.linear(static_cast<Eigen::Index>(row),
                                    static_cast<Eigen::Index>(column)) =
                    static_cast<double>(read_gltf_float(view, i, 4 * column + row));
            }
        }
        for (std::size_t row = 0; row < 3; ++row) {
            inverse_bind.translation[static_cast<Eigen::Index>(row)] =
                static_cast<double>(read_gltf_float(view, i, 12 + row));
        }
        if (!inverse_bind.linear.allFinite() || !is_finite(inverse_bind.translation)) {
            return refuse(place,
                          "expected finite matrices, found another at joint " + std::to_string(i));
        }
        Affine& to_scene = to_scene_[i];
        to_scene.translation += to_scene.linear * inverse_bind.translation;
        to_scene.linear = (to_scene.linear * inverse_bind.linear).eval();
    }
    return true;
}

bool SkinReader::read_meshes() {
    for (const PlacedNode& placed : placed_) {
        const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.node)];
        if (node.mesh == -1 || node.skin == -1) {
            continue;
        }
        if (!is_gltf_index(node.mesh, model_.meshes.size())) {
            return reader_.refuse_index(gltf_pointer("nodes", placed.node) + "/mesh", "mesh",
                                        model_.meshes.size(), node.mesh);
        }
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const std::string place =
                gltf_pointer("meshes", node.mesh) + "/primitives/" + std::to_string(i);
            if (!read_primitive(mesh.primitives[i], place)) {
                return false;
            }
        }
    }
    return !skin_.triangles.empty() || refuse("/meshes", "expected triangles on the skin");
}

bool SkinReader::view_vertices(const tinygltf::Primitive& primitive, const std::string& place,
                               VertexViews& views) {
    const auto view = [&](const char* name, GltfElements elements, AccessorView& out) {
        const auto found = primitive.attributes.find(name);
        const std::string attribute_place = place + "/attributes/" + name;
        if (found == primitive.attributes.end()) {
            return refuse(attribute_place, "expected this attribute on a skinned mesh");
        }
        if (!reader_.view_accessor(found->second, elements, attribute_place, out)) {
            return false;
        }
        if (out.count != views.positions.count && &out != &views.positions) {
            return refuse(attribute_place, "expected as many elements as positions, " +
                                               std::to_string(views.positions.count) + ", found " +
                                               std::to_string(out.count));
        }
        return true;
    };
    if (primitive.attributes.contains("JOINTS_1")) {
        return refuse(place + "/attributes/JOINTS_1", "expected at most four joints a vertex");
    }
    views.has_normals = primitive.attributes.contains("NORMAL");
    return view("POSITION", GltfElements::vectors, views.positions) &&
           view("JOINTS_0", GltfElements::joints, views.joints) &&
           view("WEIGHTS_0", GltfElements::weights, views.weights) &&
           (!views.has_normals || view("NORMAL", GltfElements::vectors, views.normals));
}

bool SkinReader::read_primitive(const tinygltf::Primitive& primitive, const std::string& place) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES) {
        return refuse(place + "/mode", "expected triangles");
    }
    VertexViews views;
    if (!view_vertices(primitive, place, views) ||
        !reader_.read_indices(primitive.indices, place + "/indices", views.positions.count,
                              indices_)) {
        return false;
    }
    const std::size_t first = skin_.positions.size();
    if (first + views.positions.count > k_max_level_size ||
        skin_.triangles.size() + indices_.size() / 3 > k_max_level_size) {
        return refuse(place, "expected at most " + std::to_string(k_max_level_size) +
                                 " vertices and triangles");
    }
    if (indices_.size() % 3 != 0) {
        return refuse(place, "expected 3 corners a triangle, found " +
                                 std::to_string(indices_.size()) + " corners");
    }
    for (std::size_t i = 0; i < views.positions.count; ++i) {
        if (!append_weights(views, i, place) || !append_vertex(views, i, place)) {
            return false;
        }
    }
    ColorRun run = {static_cast<std::uint32_t>(skin_.triangles.size()), {0.6F, 0.6F, 0.62F}};
    if (primitive.material != -1) {
        if (!is_gltf_index(primitive.material, model_.materials.size())) {
            return reader_.refuse_index(place + "/material", "material", model_.materials.size(),
                                        primitive.material);
        }
        read_gltf_material(model_.materials[static_cast<std::size_t>(primitive.material)], run);
    }
    skin_.color_runs.push_back(run);
    Mesh mesh;  // for its triangles without those that have no area
    mesh.positions.swap(skin_.positions);
    mesh.triangles.swap(skin_.triangles);
    append_triangles(TriangleMode::list, Winding::kept, indices_, static_cast<std::uint32_t>(first),
                     mesh);
    mesh.positions.swap(skin_.positions);
    mesh.triangles.swap(skin_.triangles);
    return true;
}

bool SkinReader::append_weights(const VertexViews& views, std::size_t i, const std::string& place) {
    SkinWeights weights;
    float sum = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t joint = read_gltf_unsigned(views.joints, i, k);
        if (joint >= skin_.joints.size()) {
            return refuse(place + "/attributes/JOINTS_0", "expected joints below " +
                                                              std::to_string(skin_.joints.size()) +
                                                              ", found " + std::to_string(joint) +
                                                              " at vertex " + std::to_string(i));
        }
        weights.joint[k] = static_cast<std::uint16_t>(joint);
        weights.weight[k] = read_gltf_share(views.weights, i, k);
        if (!(weights.weight[k] >= 0.0F) || weights.weight[k] > 1e6F) {
            return refuse(
                place + "/attributes/WEIGHTS_0",
                "expected weights from 0 on, found another at vertex " + std::to_string(i));
        }
        sum += weights.weight[k];
    }
    if (!(sum > 1e-3F)) {
        return refuse(
            place + "/attributes/WEIGHTS_0",
            "expected a sum of weights above 0, found none at vertex " + std::to_string(i));
    }
    for (float& weight : weights.weight) {
        weight /= sum;
    }
    skin_.weights.push_back(weights);
    return true;
}

// After append_weights: where the joints carry the vertex as the file stands.
bool SkinReader::append_vertex(const VertexViews& views, std::size_t i, const std::string& place) {
    const SkinWeights& weights = skin_.weights.back();
    Affine blend{Mat3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 4; ++k) {
        const double weight = static_cast<double>(weights.weight[k]);
        blend.linear += weight * to_scene_[weights.joint[k]].linear;
        blend.translation += weight * to_scene_[weights.joint[k]].translation;
    }
    const Vec3 position = blend.linear * read_gltf_vector(views.positions, i) + blend.translation;
    if (!is_finite(position) || position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
        return refuse(
            place + "/attributes/POSITION",
            "expected finite positions within 1e7 m, found another at vertex " + std::to_string(i));
    }
    Vec3 normal = Vec3::Zero();
    if (views.has_normals) {
        normal = blend.linear * read_gltf_vector(views.normals, i);
        if (!is_finite(normal)) {
            return refuse(place + "/attributes/NORMAL",
                          "expected finite normals, found another at vertex " + std::to_string(i));
        }
    }
    skin_.positions.push_back(position);
    skin_.normals.push_back(normal.norm() > 1e-9 ? normal.normalized() : Vec3::Zero());
    return true;
}

void SkinReader::finish_normals() {
    std::vector<Vec3> sums(skin_.positions.size(), Vec3::Zero());
    for (const auto& [a, b, c] : skin_.triangles) {
        const Vec3 area = (skin_.positions[b] - skin_.positions[a])
                              .cross(skin_.positions[c] - skin_.positions[a]);
        sums[a] += area;
        sums[b] += area;
        sums[c] += area;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (skin_.normals[i] == Vec3::Zero()) {
            const double length = sums[i].norm();
            skin_.normals[i] = length > 0.0 && std::isfinite(length) ? Vec3(sums[i] / length)
                                                                     : Vec3(Vec3::UnitY());
        }
    }
}

}  // namespace

Result<SkinnedMesh> parse_gltf_skin(std::string_view bytes, const std::filesystem::path& path) {
    const Result<std::string> glb = extract_geometry_glb(bytes, path.string(), GltfUse::skinned);
    if (!glb) {
        return glb.error();
    }
    const Result<tinygltf::Model> model = parse_gltf_model(glb.value(), path);
    if (!model) {
        return model.error();
    }
    return SkinReader(model.value(), path.string()).read();
}

Result<SkinnedMesh> load_gltf_skin(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return bytes.error();
    }
    return parse_gltf_skin(bytes.value(), path);
}

}  // namespace handhold
