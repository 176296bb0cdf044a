#include "engine/io/gltf_skin.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_bind_pose.hpp"
#include "engine/io/gltf_buffers.hpp"
#include "engine/io/gltf_influences.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_primitive.hpp"
#include "engine/io/gltf_scene.hpp"
#include "engine/io/gltf_skin_bindings.hpp"
#include "engine/io/gltf_skin_joints.hpp"
#include "engine/io/triangle_list.hpp"

namespace handhold {
namespace {

// Reads a model's scene into one skinned mesh. Stops at the first error.
class SkinReader {
  public:
    SkinReader(const gltf::Model& model, std::span<const std::string_view> buffers,
               gltf::Refusal& refusal, gltf::JointSource source)
        : model_(model), refusal_(refusal), reader_(model, buffers, refusal), source_(source) {
        skin_.file = refusal.file();
    }

    bool read() {
        if (!gltf::place_scene(model_, refusal_, placed_) ||
            !gltf::pose_as_bound(model_, reader_, refusal_, placed_) ||
            !gltf::read_skin_joints(model_, placed_, source_, refusal_, joints_) ||
            !read_meshes()) {
            return false;
        }
        skin_.joints = std::move(joints_.list);
        finish_normals();
        add_notes();
        return true;
    }
    SkinnedMesh take_skin() { return std::move(skin_); }

  private:
    bool refuse(std::string place, std::string expected) {
        return refusal_.refuse(std::move(place), std::move(expected));
    }
    bool read_meshes();
    bool read_primitive(const gltf::Primitive& primitive, const gltf::SkinBinding& binding,
                        const std::string& place);
    bool append_skinned(const gltf::SkinBinding& binding, const std::string& place,
                        std::size_t& mirrored);
    void append_weights(const gltf::SkinBinding& binding, Affine& to_scene);
    bool append_vertex(std::size_t vertex, const Affine& to_scene, const std::string& place);
    void append_surface(const gltf::Material* material, std::size_t first, bool is_mirrored);
    void finish_normals();
    void add_notes();

    const gltf::Model& model_;
    gltf::Refusal& refusal_;
    gltf::AccessorReader reader_;
    gltf::JointSource source_;
    SkinnedMesh skin_;
    std::vector<PlacedNode> placed_;
    gltf::SkinJoints joints_;
    gltf::PrimitiveData primitive_;            // scratch
    std::vector<gltf::Influence> influences_;  // scratch: those of one vertex, heaviest first
    std::size_t skipped_primitives_ = 0;
    std::size_t reduced_vertices_ = 0;     // vertices with more than four joints
    std::size_t unweighted_vertices_ = 0;  // vertices without a weight above 0
};

bool SkinReader::read_meshes() {
    gltf::SkinBindings bindings(model_, joints_, reader_, refusal_);
    for (const PlacedNode& placed : placed_) {
        const gltf::Node& node = gltf::element(model_.nodes, placed.node);
        if (node.mesh == gltf::k_none ||
            (node.skin == gltf::k_none && source_ == gltf::JointSource::skin)) {
            continue;
        }
        if (!gltf::has_element(model_.meshes, node.mesh)) {
            return refusal_.refuse_index(gltf::pointer("nodes", placed.node) + "/mesh", "mesh",
                                         model_.meshes.size(), node.mesh);
        }
        const gltf::SkinBinding* const binding = bindings.bind(placed);
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
           refuse("/meshes", source_ == gltf::JointSource::skin ? "expected triangles on the skin"
                                                                : "expected triangles");
}

bool SkinReader::read_primitive(const gltf::Primitive& primitive, const gltf::SkinBinding& binding,
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
    for (const gltf::SkinSlot& slot : binding.slots) {
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
bool SkinReader::append_skinned(const gltf::SkinBinding& binding, const std::string& place,
                                std::size_t& mirrored) {
    for (std::size_t i = 0; i < primitive_.vertices; ++i) {
        Affine to_scene;
        if (!gltf::collect_influences(primitive_, i, binding.slots.size(), place, refusal_,
                                      influences_)) {
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

// Appends the four heaviest influences, scaled to a sum of 1. Sets `to_scene` to the map of the
// vertex.
void SkinReader::append_weights(const gltf::SkinBinding& binding, Affine& to_scene) {
    constexpr float k_min_sum = 1e-12F;
    SkinWeights weights;
    if (influences_.size() > weights.joint.size()) {
        std::stable_sort(
            influences_.begin(), influences_.end(),
            [](const gltf::Influence& a, const gltf::Influence& b) { return a.weight > b.weight; });
        influences_.resize(weights.joint.size());
        ++reduced_vertices_;
    }
    float sum = 0.0F;
    for (const gltf::Influence& influence : influences_) {
        sum += influence.weight;
    }
    if (!(sum > k_min_sum)) {
        influences_.assign(1, {0, 1.0F});
        sum = 1.0F;
        ++unweighted_vertices_;
    }
    to_scene = {Mat3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < influences_.size(); ++k) {
        const gltf::SkinSlot& slot = binding.slots[influences_[k].slot];
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
                                 gltf::JointSource source) {
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
    return parse_joints(bytes, path, gltf::JointSource::skin);
}

Result<SkinnedMesh> parse_gltf_figure(std::string_view bytes, const std::filesystem::path& path) {
    return parse_joints(bytes, path, gltf::JointSource::scene);
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
