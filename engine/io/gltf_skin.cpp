#include "engine/io/gltf_skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_buffers.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_primitive.hpp"
#include "engine/io/gltf_scene.hpp"
#include "engine/io/text_file.hpp"
#include "engine/io/triangle_list.hpp"

namespace handhold {
namespace {

// A pose whose Y axis has the direction of the frame's Y axis. Its Z axis is as close as possible
// to the frame's.
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

// The nodes that become joints: the joints of the only skin, or all nodes of the scene.
enum class JointSource { skin, scene };

// Reads a model's scene into one skinned mesh. Stops at the first error.
class SkinReader {
  public:
    SkinReader(const gltf::Model& model, std::span<const std::string_view> buffers,
               gltf::Refusal& refusal, JointSource source)
        : model_(model), refusal_(refusal), reader_(model, buffers, refusal), source_(source) {
        skin_.file = refusal.file();
    }

    bool read() {
        if (!gltf::place_scene(model_, refusal_, placed_) || !choose_skin() || !read_joints() ||
            !read_meshes()) {
            return false;
        }
        finish_normals();
        add_notes();
        return true;
    }
    SkinnedMesh take_skin() { return std::move(skin_); }

  private:
    // One entry of a skin's joint list: the joint, and the map from the mesh's bind space to the
    // scene.
    struct Slot {
        std::uint16_t joint = 0;
        Affine to_scene;
    };
    // The slots that move a mesh: those of its skin, or those of its node.
    struct Binding {
        std::vector<Slot> slots;
        bool is_skinned = false;
    };
    // A vertex's influence by one slot.
    struct Influence {
        std::size_t slot = 0;
        float weight = 0.0F;
    };

    bool refuse(std::string place, std::string expected) {
        return refusal_.refuse(std::move(place), std::move(expected));
    }
    bool choose_skin();
    bool read_joints();
    bool list_joints(std::vector<int>& nodes);
    bool check_joint_count(std::size_t count, const std::string& place);
    bool append_joint(const PlacedNode& placed);
    void find_parents();
    const Binding* bind(const PlacedNode& placed);
    bool bind_skin(int skin, Binding& binding);
    bool apply_inverse_binds(int skin, Binding& binding);
    bool read_meshes();
    bool read_primitive(const gltf::Primitive& primitive, const Binding& binding,
                        const std::string& place);
    bool append_skinned(const Binding& binding, const std::string& place, std::size_t& mirrored);
    bool collect_influences(std::size_t vertex, const Binding& binding, const std::string& place);
    void append_weights(const Binding& binding, Affine& to_scene);
    bool append_vertex(std::size_t vertex, const Affine& to_scene, const std::string& place);
    void append_surface(const gltf::Material* material, std::size_t first, bool is_mirrored);
    void finish_normals();
    void add_notes();

    const gltf::Model& model_;
    gltf::Refusal& refusal_;
    gltf::AccessorReader reader_;
    JointSource source_;
    SkinnedMesh skin_;
    int skin_index_ = gltf::k_none;  // used only with JointSource::skin
    std::vector<PlacedNode> placed_;
    std::map<int, const PlacedNode*> by_node_;
    std::map<int, std::uint16_t> joint_of_node_;
    std::map<int, Binding> skins_;       // by skin; only skins that a mesh uses
    Binding rigid_;                      // for the mesh being read, if it has no skin
    gltf::PrimitiveData primitive_;      // scratch
    std::vector<Influence> influences_;  // scratch: those of one vertex, heaviest first
    std::size_t skipped_primitives_ = 0;
    std::size_t reduced_vertices_ = 0;     // vertices with more than four joints
    std::size_t unweighted_vertices_ = 0;  // vertices without a weight above 0
};

bool SkinReader::choose_skin() {
    if (source_ == JointSource::scene) {
        return true;
    }
    for (const PlacedNode& placed : placed_) {
        const gltf::Node& node = gltf::element(model_.nodes, placed.node);
        if (node.mesh == gltf::k_none || node.skin == gltf::k_none) {
            continue;
        }
        const std::string place = gltf::pointer("nodes", placed.node) + "/skin";
        if (!gltf::has_element(model_.skins, node.skin)) {
            return refusal_.refuse_index(place, "skin", model_.skins.size(), node.skin);
        }
        if (skin_index_ != gltf::k_none && skin_index_ != node.skin) {
            return refuse(place, "expected one skin, found a second one");
        }
        skin_index_ = node.skin;
    }
    return skin_index_ != gltf::k_none || refuse("/nodes", "expected a mesh with a skin");
}

// Lists the nodes that become joints, in order.
bool SkinReader::list_joints(std::vector<int>& nodes) {
    if (source_ == JointSource::skin) {
        nodes = gltf::element(model_.skins, skin_index_).joints;
    } else {
        for (const PlacedNode& placed : placed_) {
            nodes.push_back(placed.node);
        }
    }
    const std::string place =
        source_ == JointSource::skin ? gltf::pointer("skins", skin_index_) + "/joints" : "/nodes";
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
            return gltf::pointer("skins", skin_index_) + "/joints/" + std::to_string(i);
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
        return refuse(gltf::pointer("nodes", placed.node),
                      "expected a joint without uneven scale, shear or mirroring");
    }
    const gltf::Node& node = gltf::element(model_.nodes, placed.node);
    skin_.joints.push_back({node.name, -1, *pose, node.numbers});
    return true;
}

void SkinReader::find_parents() {
    std::map<int, std::int32_t> joint_above;    // by node: the nearest joint above it
    for (const PlacedNode& placed : placed_) {  // parents first
        const auto self = joint_of_node_.find(placed.node);
        const auto above = joint_above.find(placed.node);
        std::int32_t joint = above == joint_above.end() ? -1 : above->second;
        if (self != joint_of_node_.end()) {
            skin_.joints[static_cast<std::size_t>(self->second)].parent = joint;
            joint = self->second;
        }
        for (const int child : gltf::element(model_.nodes, placed.node).children) {
            joint_above[child] = joint;
        }
    }
}

// The slots that move the node's mesh; null after an error.
const SkinReader::Binding* SkinReader::bind(const PlacedNode& placed) {
    const int skin = gltf::element(model_.nodes, placed.node).skin;
    if (skin == gltf::k_none) {
        // One slot per instance: all follow the node's joint.
        std::vector<Affine> frames;
        if (!gltf::place_instances(placed, model_, reader_, refusal_, frames)) {
            return nullptr;
        }
        rigid_.slots.clear();
        for (const Affine& frame : frames) {
            rigid_.slots.push_back({joint_of_node_[placed.node], frame});
        }
        return &rigid_;
    }
    if (!gltf::has_element(model_.skins, skin)) {
        refusal_.refuse_index(gltf::pointer("nodes", placed.node) + "/skin", "skin",
                              model_.skins.size(), skin);
        return nullptr;
    }
    const auto [entry, is_new] = skins_.try_emplace(skin);
    return !is_new || bind_skin(skin, entry->second) ? &entry->second : nullptr;
}

bool SkinReader::bind_skin(int skin, Binding& binding) {
    const std::vector<int>& nodes = gltf::element(model_.skins, skin).joints;
    const std::string place = gltf::pointer("skins", skin) + "/joints";
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
    return apply_inverse_binds(skin, binding);
}

// Multiplies the slots' maps by the inverse bind matrices, which are applied first.
bool SkinReader::apply_inverse_binds(int skin, Binding& binding) {
    const int accessor = gltf::element(model_.skins, skin).inverse_binds;
    if (accessor == gltf::k_none) {  // then they are identities (specification, 3.7.3.1)
        return true;
    }
    const std::string place = gltf::pointer("skins", skin) + "/inverseBindMatrices";
    std::vector<float> matrices;
    if (!reader_.read_floats(accessor, gltf::Elements::matrices, place, matrices)) {
        return false;
    }
    if (matrices.size() / 16 < binding.slots.size()) {
        return refuse(place, "expected a matrix for each of the " +
                                 std::to_string(binding.slots.size()) + " joints, found " +
                                 std::to_string(matrices.size() / 16));
    }
    for (std::size_t i = 0; i < binding.slots.size(); ++i) {
        const Eigen::Map<const Eigen::Matrix4f> matrix(matrices.data() + 16 * i);
        const Affine inverse_bind{matrix.topLeftCorner<3, 3>().cast<double>(),
                                  matrix.topRightCorner<3, 1>().cast<double>()};
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
        const gltf::Node& node = gltf::element(model_.nodes, placed.node);
        if (node.mesh == gltf::k_none ||
            (node.skin == gltf::k_none && source_ == JointSource::skin)) {
            continue;
        }
        if (!gltf::has_element(model_.meshes, node.mesh)) {
            return refusal_.refuse_index(gltf::pointer("nodes", placed.node) + "/mesh", "mesh",
                                         model_.meshes.size(), node.mesh);
        }
        const Binding* const binding = bind(placed);
        if (binding == nullptr) {
            return false;
        }
        const gltf::Mesh& mesh = gltf::element(model_.meshes, node.mesh);
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            if (gltf::is_skipped(mesh.primitives[i])) {
                ++skipped_primitives_;
            } else if (!read_primitive(mesh.primitives[i], *binding,
                                       gltf::pointer("meshes", node.mesh) + "/primitives/" +
                                           std::to_string(i))) {
                return false;
            }
        }
    }
    return !skin_.triangles.empty() ||
           refuse("/meshes", source_ == JointSource::skin ? "expected triangles on the skin"
                                                          : "expected triangles");
}

bool SkinReader::read_primitive(const gltf::Primitive& primitive, const Binding& binding,
                                const std::string& place) {
    const gltf::Material* material = nullptr;
    if (!gltf::read_primitive(primitive, place, {.normals = true, .weights = binding.is_skinned},
                              reader_, model_, refusal_, primitive_) ||
        !gltf::find_material(primitive, place, model_, refusal_, material)) {
        return false;
    }
    const std::size_t copies = binding.is_skinned ? 1 : binding.slots.size();
    const std::size_t triangles = count_triangles(primitive_.mode, primitive_.indices.size());
    if (skin_.positions.size() + primitive_.vertices * copies > k_max_level_size ||
        skin_.triangles.size() + triangles * copies > k_max_level_size) {
        return refuse(place, "expected at most " + std::to_string(k_max_level_size) +
                                 " vertices and triangles");
    }
    const std::size_t first = skin_.positions.size();
    if (binding.is_skinned) {
        std::size_t mirrored = 0;
        if (!append_skinned(binding, place, mirrored)) {
            return false;
        }
        append_surface(material, first, 2 * mirrored > primitive_.vertices);
        return true;
    }
    for (const Slot& slot : binding.slots) {
        const std::size_t first_of_copy = skin_.positions.size();
        for (std::size_t i = 0; i < primitive_.vertices; ++i) {
            skin_.weights.push_back({{slot.joint, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
            if (!append_vertex(i, slot.to_scene, place)) {
                return false;
            }
        }
        append_surface(material, first_of_copy, slot.to_scene.linear.determinant() < 0.0);
    }
    return true;
}

// Adds to `mirrored` the number of vertices whose joints mirror them.
bool SkinReader::append_skinned(const Binding& binding, const std::string& place,
                                std::size_t& mirrored) {
    for (std::size_t i = 0; i < primitive_.vertices; ++i) {
        Affine to_scene;
        if (!collect_influences(i, binding, place)) {
            return false;
        }
        append_weights(binding, to_scene);
        if (!append_vertex(i, to_scene, place)) {
            return false;
        }
        mirrored += to_scene.linear.determinant() < 0.0 ? 1U : 0U;
    }
    return true;
}

// Fills influences_ with the vertex's weights above 0, each joint once. The joint of a weight 0 may
// be out of range: some exporters fill unused entries with any number.
bool SkinReader::collect_influences(std::size_t vertex, const Binding& binding,
                                    const std::string& place) {
    influences_.clear();
    for (std::size_t set = 0; set < primitive_.joints.size(); ++set) {
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = primitive_.weights[set][4 * vertex + k];
            const auto slot = static_cast<std::size_t>(primitive_.joints[set][4 * vertex + k]);
            if (!(weight >= 0.0F) || weight > 1e6F) {
                return refuse(place + "/attributes/WEIGHTS_" + std::to_string(set),
                              "expected weights in [0, 1e6], found another at vertex " +
                                  std::to_string(vertex));
            }
            if (weight == 0.0F) {
                continue;
            }
            if (slot >= binding.slots.size()) {
                return refuse(place + "/attributes/JOINTS_" + std::to_string(set),
                              "expected joints below " + std::to_string(binding.slots.size()) +
                                  ", found " + std::to_string(slot) + " at vertex " +
                                  std::to_string(vertex));
            }
            const auto known =
                std::find_if(influences_.begin(), influences_.end(),
                             [&](const Influence& other) { return other.slot == slot; });
            if (known != influences_.end()) {
                known->weight += weight;
            } else {
                influences_.push_back({slot, weight});
            }
        }
    }
    return true;
}

// Appends the four heaviest influences, scaled to a sum of 1. Sets `to_scene` to the map of the
// vertex.
void SkinReader::append_weights(const Binding& binding, Affine& to_scene) {
    constexpr float k_min_sum = 1e-12F;
    SkinWeights weights;
    if (influences_.size() > weights.joint.size()) {
        std::stable_sort(
            influences_.begin(), influences_.end(),
            [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
        influences_.resize(weights.joint.size());
        ++reduced_vertices_;
    }
    float sum = 0.0F;
    for (const Influence& influence : influences_) {
        sum += influence.weight;
    }
    if (!(sum > k_min_sum)) {
        influences_.assign(1, {0, 1.0F});
        sum = 1.0F;
        ++unweighted_vertices_;
    }
    to_scene = {Mat3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < influences_.size(); ++k) {
        const Slot& slot = binding.slots[influences_[k].slot];
        weights.joint[k] = slot.joint;
        weights.weight[k] = influences_[k].weight / sum;
        const auto weight = static_cast<double>(weights.weight[k]);
        to_scene.linear += weight * slot.to_scene.linear;
        to_scene.translation += weight * slot.to_scene.translation;
    }
    skin_.weights.push_back(weights);
}

bool SkinReader::append_vertex(std::size_t vertex, const Affine& to_scene,
                               const std::string& place) {
    const auto vector_of = [vertex](const std::vector<float>& values) {
        return Vec3(Eigen::Map<const Eigen::Vector3f>(values.data() + 3 * vertex).cast<double>());
    };
    const Vec3 position = transform_point(to_scene, vector_of(primitive_.positions));
    if (!is_finite(position) || position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
        return refuse(place + "/attributes/POSITION",
                      "expected finite positions within 1e7 m, found another at vertex " +
                          std::to_string(vertex));
    }
    Vec3 normal = Vec3::Zero();
    if (!primitive_.normals.empty()) {
        const Vec3 in_file = vector_of(primitive_.normals);
        if (in_file.norm() > 1e-9) {
            normal = transform_normal(to_scene.linear, in_file).stableNormalized();
        }
        if (!is_finite(in_file) || !is_finite(normal)) {
            return refuse(
                place + "/attributes/NORMAL",
                "expected finite normals, found another at vertex " + std::to_string(vertex));
        }
    }
    skin_.positions.push_back(position);
    skin_.normals.push_back(normal);
    return true;
}

// Appends the primitive's triangles. Its first vertex is vertex `first` of the skin.
void SkinReader::append_surface(const gltf::Material* material, std::size_t first,
                                bool is_mirrored) {
    ColorRun run = {static_cast<std::uint32_t>(skin_.triangles.size()), {0.6F, 0.6F, 0.62F}};
    if (material != nullptr) {
        run.color = material->color;
        run.emissive = material->emissive;
        run.opacity = material->opacity;
        run.gloss = material->gloss;
    }
    skin_.color_runs.push_back(run);
    Mesh mesh;  // append_triangles needs a Mesh
    mesh.positions.swap(skin_.positions);
    mesh.triangles.swap(skin_.triangles);
    append_triangles(primitive_.mode, is_mirrored ? Winding::reversed : Winding::kept,
                     primitive_.indices, static_cast<std::uint32_t>(first), mesh);
    mesh.positions.swap(skin_.positions);
    mesh.triangles.swap(skin_.triangles);
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

void SkinReader::add_notes() {
    std::vector<std::string> notes = model_.notes;
    const auto add = [&](const char* what, std::size_t count) {
        if (count > 0) {
            notes.push_back(what + std::to_string(count));
        }
    };
    add("skipped primitives that are points, lines or without positions: ", skipped_primitives_);
    add("vertices with more than 4 joints, reduced to the 4 heaviest: ", reduced_vertices_);
    add("vertices without weights, which follow the skin's first joint: ", unweighted_vertices_);
    for (const std::string& note : notes) {
        skin_.notes.push_back(gltf::note_line(skin_.file, note));
    }
}

Result<SkinnedMesh> parse_joints(std::string_view bytes, const std::filesystem::path& path,
                                 JointSource source) {
    const Result<gltf::Model> model = gltf::parse_model(bytes, path.string());
    if (!model) {
        return model.error();
    }
    gltf::Refusal refusal(path.string());
    gltf::Buffers buffers;
    if (!buffers.load(model.value(), path, refusal)) {
        return refusal.error();
    }
    SkinReader reader(model.value(), buffers.bytes(), refusal, source);
    if (!reader.read()) {
        return refusal.error();
    }
    return reader.take_skin();
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
