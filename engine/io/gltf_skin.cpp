#include "engine/io/gltf_skin.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "engine/io/gltf_model.hpp"
#include "engine/io/text_file.hpp"
#include "engine/io/triangle_list.hpp"

namespace handhold {
namespace {

// What a frame's Y is turned to stays, then Z as near as that allows.
Pose straightened(const Affine& frame) {
    Vec3 y = frame.linear.col(1);
    Vec3 z = frame.linear.col(2);
    const double length_y = y.norm();
    const double length_z = z.norm();
    y = length_y > 1e-9 ? Vec3(y / length_y) : Vec3(Vec3::UnitY());
    z = length_z > 1e-9 ? Vec3(z / length_z) : Vec3(Vec3::UnitZ());
    const Vec3 x = y.cross(z);
    const double across = x.norm();
    if (!(across > 1e-6) || !std::isfinite(across)) {
        return {frame.translation, Quat::Identity()};
    }
    Mat3 axes;
    axes.col(0) = x / across;
    axes.col(1) = y;
    axes.col(2) = Vec3(axes.col(0)).cross(y);
    return {frame.translation, Quat(axes).normalized()};
}

// Which nodes are joints: those that the one skin names, or all of the scene.
enum class JointSource { skin, scene };

// The first error stops it.
class SkinReader {
  public:
    SkinReader(const tinygltf::Model& model, std::string file, JointSource source)
        : model_(model), reader_(model, file), source_(source) {
        skin_.file = std::move(file);
    }

    Result<SkinnedMesh> read() {
        if (!reader_.place_scene(placed_) || !choose_skin() || !read_joints() || !read_meshes()) {
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
    // What the vertices of a mesh name as joints: the joint, and the way from the mesh's bind
    // space.
    struct Slot {
        std::uint16_t joint = 0;
        Affine to_scene;
    };
    // Of one mesh: the slots of its skin, or its node alone.
    struct Binding {
        std::vector<Slot> slots;
        bool is_skinned = false;
    };

    bool refuse(std::string place, std::string expected) {
        return reader_.refuse(std::move(place), std::move(expected));
    }
    bool choose_skin();
    bool read_joints();
    bool list_joints(std::vector<int>& nodes);
    bool check_joint_count(std::size_t count, const std::string& place);
    bool append_joint(const PlacedNode& placed);
    void find_parents();
    const Binding* bind(const PlacedNode& placed);
    bool bind_skin(int skin, Binding& binding);
    bool undo_binds(int skin, Binding& binding);
    bool read_meshes();
    bool read_primitive(const tinygltf::Primitive& primitive, const Binding& binding,
                        const std::string& place);
    bool view_vertices(const tinygltf::Primitive& primitive, bool is_skinned,
                       const std::string& place, VertexViews& views);
    bool append_vertex(const VertexViews& views, std::size_t i, const Affine& to_scene,
                       const std::string& place);
    bool append_weights(const VertexViews& views, std::size_t i, const Binding& binding,
                        const std::string& place, Affine& to_scene);
    void finish_normals();

    const tinygltf::Model& model_;
    GltfModelReader reader_;
    JointSource source_;
    SkinnedMesh skin_;
    int skin_index_ = -1;  // of JointSource::skin
    std::vector<PlacedNode> placed_;
    std::map<int, const PlacedNode*> by_node_;
    std::map<int, std::uint16_t> joint_of_node_;
    std::map<int, Binding> skins_;  // by skin, those that were needed
    Binding rigid_;                 // of the node that is being read
    std::vector<std::uint32_t> indices_;
};

bool SkinReader::choose_skin() {
    if (source_ == JointSource::scene) {
        return true;
    }
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

// The nodes that are joints, in order.
bool SkinReader::list_joints(std::vector<int>& nodes) {
    if (source_ == JointSource::skin) {
        nodes = model_.skins[static_cast<std::size_t>(skin_index_)].joints;
    } else {
        for (const PlacedNode& placed : placed_) {
            nodes.push_back(placed.node);
        }
    }
    const std::string place =
        source_ == JointSource::skin ? gltf_pointer("skins", skin_index_) + "/joints" : "/nodes";
    return check_joint_count(nodes.size(), place);
}

bool SkinReader::check_joint_count(std::size_t count, const std::string& place) {
    return (count > 0 && count <= k_max_skin_joints) ||
           refuse(place, "expected 1 to " + std::to_string(k_max_skin_joints) + " joints, found " +
                             std::to_string(count));
}

bool SkinReader::read_joints() {
    std::vector<int> nodes;
    if (!list_joints(nodes)) {
        return false;
    }
    for (const PlacedNode& placed : placed_) {
        by_node_[placed.node] = &placed;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = by_node_.find(nodes[i]);
        const auto place = [&] {
            return gltf_pointer("skins", skin_index_) + "/joints/" + std::to_string(i);
        };
        if (node == by_node_.end()) {
            return refuse(place(),
                          "expected a node of the scene, found " + std::to_string(nodes[i]));
        }
        if (!joint_of_node_.emplace(nodes[i], static_cast<std::uint16_t>(i)).second) {
            return refuse(place(), "expected every joint once");
        }
        if (!append_joint(*node->second)) {
            return false;
        }
    }
    find_parents();
    return true;
}

bool SkinReader::append_joint(const PlacedNode& placed) {
    std::optional<Pose> pose = rigid_part(placed.world);
    const bool is_mirrored =
        rigid_part({Mat3(-placed.world.linear), placed.world.translation}).has_value();
    if (!pose && (source_ == JointSource::scene || is_mirrored) &&
        is_finite(placed.world.translation)) {
        pose = straightened(placed.world);
    }
    if (!pose || pose->position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
        return refuse(gltf_pointer("nodes", placed.node),
                      "expected a joint that is turned, moved and evenly scaled at most");
    }
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.node)];
    skin_.joints.push_back({node.name, -1, *pose, read_gltf_numbers(node.extras)});
    return true;
}

void SkinReader::find_parents() {
    std::map<int, std::int32_t> joint_above;    // by node
    for (const PlacedNode& placed : placed_) {  // parents first
        const auto self = joint_of_node_.find(placed.node);
        const auto above = joint_above.find(placed.node);
        std::int32_t joint = above == joint_above.end() ? -1 : above->second;
        if (self != joint_of_node_.end()) {
            skin_.joints[static_cast<std::size_t>(self->second)].parent = joint;
            joint = self->second;
        }
        for (const int child : model_.nodes[static_cast<std::size_t>(placed.node)].children) {
            joint_above[child] = joint;
        }
    }
}

// Null where it is refused.
const SkinReader::Binding* SkinReader::bind(const PlacedNode& placed) {
    const int skin = model_.nodes[static_cast<std::size_t>(placed.node)].skin;
    if (skin == -1) {
        rigid_.slots = {{joint_of_node_[placed.node], placed.world}};
        return &rigid_;
    }
    if (!is_gltf_index(skin, model_.skins.size())) {
        reader_.refuse_index(gltf_pointer("nodes", placed.node) + "/skin", "skin",
                             model_.skins.size(), skin);
        return nullptr;
    }
    const auto [entry, is_new] = skins_.try_emplace(skin);
    return !is_new || bind_skin(skin, entry->second) ? &entry->second : nullptr;
}

bool SkinReader::bind_skin(int skin, Binding& binding) {
    const std::vector<int>& nodes = model_.skins[static_cast<std::size_t>(skin)].joints;
    const std::string place = gltf_pointer("skins", skin) + "/joints";
    if (!check_joint_count(nodes.size(), place)) {
        return false;
    }
    std::set<int> seen;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto joint = joint_of_node_.find(nodes[i]);
        if (joint == joint_of_node_.end()) {
            return refuse(place + "/" + std::to_string(i),
                          "expected a node of the scene, found " + std::to_string(nodes[i]));
        }
        if (!seen.insert(nodes[i]).second) {
            return refuse(place + "/" + std::to_string(i), "expected every joint once");
        }
        binding.slots.push_back({joint->second, by_node_[nodes[i]]->world});
    }
    binding.is_skinned = true;
    return undo_binds(skin, binding);
}

bool SkinReader::undo_binds(int skin, Binding& binding) {
    const int accessor = model_.skins[static_cast<std::size_t>(skin)].inverseBindMatrices;
    if (accessor == -1) {  // then they are identities (specification, 3.7.3.1)
        return true;
    }
    const std::string place = gltf_pointer("skins", skin) + "/inverseBindMatrices";
    AccessorView view;
    if (!reader_.view_accessor(accessor, GltfElements::matrices, place, view)) {
        return false;
    }
    if (view.count < binding.slots.size()) {
        return refuse(place, "expected a matrix for each of the " +
                                 std::to_string(binding.slots.size()) + " joints, found " +
                                 std::to_string(view.count));
    }
    for (std::size_t i = 0; i < binding.slots.size(); ++i) {
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
        binding.slots[i].to_scene = binding.slots[i].to_scene * inverse_bind;
    }
    return true;
}

bool SkinReader::read_meshes() {
    for (const PlacedNode& placed : placed_) {
        const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.node)];
        if (node.mesh == -1 || (node.skin == -1 && source_ == JointSource::skin)) {
            continue;
        }
        if (!is_gltf_index(node.mesh, model_.meshes.size())) {
            return reader_.refuse_index(gltf_pointer("nodes", placed.node) + "/mesh", "mesh",
                                        model_.meshes.size(), node.mesh);
        }
        const Binding* const binding = bind(placed);
        if (binding == nullptr) {
            return false;
        }
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const std::string place =
                gltf_pointer("meshes", node.mesh) + "/primitives/" + std::to_string(i);
            if (!read_primitive(mesh.primitives[i], *binding, place)) {
                return false;
            }
        }
    }
    return !skin_.triangles.empty() ||
           refuse("/meshes", source_ == JointSource::skin ? "expected triangles on the skin"
                                                          : "expected triangles");
}

bool SkinReader::view_vertices(const tinygltf::Primitive& primitive, bool is_skinned,
                               const std::string& place, VertexViews& views) {
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
           (!is_skinned || (view("JOINTS_0", GltfElements::joints, views.joints) &&
                            view("WEIGHTS_0", GltfElements::weights, views.weights))) &&
           (!views.has_normals || view("NORMAL", GltfElements::vectors, views.normals));
}

bool SkinReader::read_primitive(const tinygltf::Primitive& primitive, const Binding& binding,
                                const std::string& place) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES) {
        return refuse(place + "/mode", "expected triangles");
    }
    VertexViews views;
    if (!view_vertices(primitive, binding.is_skinned, place, views) ||
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
    std::size_t mirrored = 0;
    for (std::size_t i = 0; i < views.positions.count; ++i) {
        Affine to_scene;
        if (!append_weights(views, i, binding, place, to_scene) ||
            !append_vertex(views, i, to_scene, place)) {
            return false;
        }
        mirrored += to_scene.linear.determinant() < 0.0 ? 1U : 0U;
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
    const bool is_mirrored = 2 * mirrored > views.positions.count;
    append_triangles(TriangleMode::list, is_mirrored ? Winding::reversed : Winding::kept, indices_,
                     static_cast<std::uint32_t>(first), mesh);
    mesh.positions.swap(skin_.positions);
    mesh.triangles.swap(skin_.triangles);
    return true;
}

// Also where these joints take the vertex as the file stands.
bool SkinReader::append_weights(const VertexViews& views, std::size_t i, const Binding& binding,
                                const std::string& place, Affine& to_scene) {
    if (!binding.is_skinned) {
        const Slot& slot = binding.slots.front();
        skin_.weights.push_back({{slot.joint, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
        to_scene = slot.to_scene;
        return true;
    }
    SkinWeights weights;
    std::array<std::size_t, 4> slots{};
    float sum = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) {
        slots[k] = read_gltf_unsigned(views.joints, i, k);
        if (slots[k] >= binding.slots.size()) {
            return refuse(place + "/attributes/JOINTS_0",
                          "expected joints below " + std::to_string(binding.slots.size()) +
                              ", found " + std::to_string(slots[k]) + " at vertex " +
                              std::to_string(i));
        }
        weights.joint[k] = binding.slots[slots[k]].joint;
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
    to_scene = {Mat3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 4; ++k) {
        weights.weight[k] /= sum;
        const double weight = static_cast<double>(weights.weight[k]);
        to_scene.linear += weight * binding.slots[slots[k]].to_scene.linear;
        to_scene.translation += weight * binding.slots[slots[k]].to_scene.translation;
    }
    skin_.weights.push_back(weights);
    return true;
}

bool SkinReader::append_vertex(const VertexViews& views, std::size_t i, const Affine& to_scene,
                               const std::string& place) {
    const Vec3 position = transform_point(to_scene, read_gltf_vector(views.positions, i));
    if (!is_finite(position) || position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
        return refuse(
            place + "/attributes/POSITION",
            "expected finite positions within 1e7 m, found another at vertex " + std::to_string(i));
    }
    Vec3 normal = Vec3::Zero();
    if (views.has_normals) {
        const Vec3 in_file = read_gltf_vector(views.normals, i);
        if (in_file.norm() > 1e-9) {
            normal = transform_normal(to_scene.linear, in_file).stableNormalized();
        }
        if (!is_finite(in_file) || !is_finite(normal)) {
            return refuse(place + "/attributes/NORMAL",
                          "expected finite normals, found another at vertex " + std::to_string(i));
        }
    }
    skin_.positions.push_back(position);
    skin_.normals.push_back(normal);
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

Result<SkinnedMesh> parse_joints(std::string_view bytes, const std::filesystem::path& path,
                                 JointSource source) {
    const Result<std::string> glb = extract_geometry_glb(bytes, path.string(), GltfUse::skinned);
    if (!glb) {
        return glb.error();
    }
    const Result<tinygltf::Model> model = parse_gltf_model(glb.value(), path);
    if (!model) {
        return model.error();
    }
    return SkinReader(model.value(), path.string(), source).read();
}

}  // namespace

Result<SkinnedMesh> parse_gltf_skin(std::string_view bytes, const std::filesystem::path& path) {
    return parse_joints(bytes, path, JointSource::skin);
}

Result<SkinnedMesh> parse_gltf_figure(std::string_view bytes, const std::filesystem::path& path) {
    return parse_joints(bytes, path, JointSource::scene);
}

Result<SkinnedMesh> load_gltf_skin(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    return bytes ? parse_gltf_skin(bytes.value(), path) : bytes.error();
}

Result<SkinnedMesh> load_gltf_figure(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    return bytes ? parse_gltf_figure(bytes.value(), path) : bytes.error();
}

}  // namespace handhold
