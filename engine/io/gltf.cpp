#include "engine/io/gltf.hpp"

#include <map>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_buffers.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_primitive.hpp"
#include "engine/io/gltf_scene.hpp"
#include "engine/io/triangle_list.hpp"
#include "engine/math/math.hpp"

namespace handhold {

namespace {

// Reads a model's scene into parts. Stops at the first error.
class LevelReader {
  public:
    LevelReader(const gltf::Model& model, std::span<const std::string_view> buffers,
                gltf::Refusal& refusal)
        : model_(model), refusal_(refusal), reader_(model, buffers, refusal) {}

    bool read() {
        std::vector<PlacedNode> placed;
        if (!gltf::place_scene(model_, refusal_, placed)) {
            return false;
        }
        for (const PlacedNode& node : placed) {
            if (gltf::element(model_.nodes, node.node).mesh != gltf::k_none && !read_part(node)) {
                return false;
            }
        }
        add_notes();
        return true;
    }
    GltfLevel take_level() { return std::move(level_); }

  private:
    bool read_part(const PlacedNode& placed);
    bool read_primitive(const gltf::Primitive& primitive, const std::string& place,
                        LevelPart& part);
    bool append_positions(const Affine& frame, const std::string& place, Mesh& mesh);
    static void begin_color(const gltf::Material* material, LevelPart& part);
    void add_notes();

    const gltf::Model& model_;
    gltf::Refusal& refusal_;
    gltf::AccessorReader reader_;
    GltfLevel level_;
    gltf::PrimitiveData primitive_;  // scratch
    std::vector<Affine> frames_;     // frames of the part being read, one per instance
    // For the part being read: the first vertex of each (POSITION accessor, instance).
    std::map<std::pair<int, std::size_t>, std::uint32_t> first_vertex_;
    std::size_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
};

bool LevelReader::read_part(const PlacedNode& placed) {
    const gltf::Node& node = gltf::element(model_.nodes, placed.node);
    const std::string place = gltf::pointer("nodes", placed.node);
    if (node.skin != gltf::k_none) {
        return refusal_.refuse(place + "/skin",
                               "expected rigid geometry, found a mesh with a skin");
    }
    if (!gltf::has_element(model_.meshes, node.mesh)) {
        return refusal_.refuse_index(place + "/mesh", "mesh", model_.meshes.size(), node.mesh);
    }
    if (!gltf::place_instances(placed, model_, reader_, refusal_, frames_)) {
        return false;
    }
    const gltf::Mesh& mesh = gltf::element(model_.meshes, node.mesh);
    LevelPart part;
    part.pointer = place;
    part.mesh.name = !node.name.empty()   ? node.name
                     : !mesh.name.empty() ? mesh.name
                                          : "node " + std::to_string(placed.node);
    part.synthetic = node.is_synthetic || mesh.is_synthetic;
    first_vertex_.clear();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        if (gltf::is_skipped(mesh.primitives[i])) {
            ++level_.skipped_primitives;
        } else if (!read_primitive(
                       mesh.primitives[i],
                       gltf::pointer("meshes", node.mesh) + "/primitives/" + std::to_string(i),
                       part)) {
            return false;
        }
    }
    if (!part.color_runs.empty()) {
        part.mesh.color = part.color_runs.front().color;
    }
    level_.parts.push_back(std::move(part));
    return true;
}

bool LevelReader::read_primitive(const gltf::Primitive& primitive, const std::string& place,
                                 LevelPart& part) {
    const int positions = primitive.attributes.at("POSITION");
    const bool may_share = !primitive.draco;  // the accessor of a Draco primitive holds no vertices
    const bool is_known = may_share && first_vertex_.contains({positions, 0});
    const gltf::Material* material = nullptr;
    if (!gltf::read_primitive(primitive, place, {.positions = !is_known}, reader_, model_, refusal_,
                              primitive_) ||
        !gltf::find_material(primitive, place, model_, refusal_, material)) {
        return false;
    }
    triangle_count_ += count_triangles(primitive_.mode, primitive_.indices.size()) * frames_.size();
    vertex_count_ += is_known ? 0 : primitive_.vertices * frames_.size();
    if (triangle_count_ > k_max_level_size || vertex_count_ > k_max_level_size) {
        return refusal_.refuse(place, "expected at most " + std::to_string(k_max_level_size) +
                                          " vertices and triangles in a level");
    }
    begin_color(material, part);
    for (std::size_t instance = 0; instance < frames_.size(); ++instance) {
        auto first = static_cast<std::uint32_t>(part.mesh.positions.size());
        if (is_known) {
            first = first_vertex_.at({positions, instance});
        } else if (!append_positions(frames_[instance], place + "/attributes/POSITION",
                                     part.mesh)) {
            return false;
        } else if (may_share) {
            first_vertex_.emplace(std::pair(positions, instance), first);
        }
        const bool is_mirrored = frames_[instance].linear.determinant() < 0.0;
        level_.dropped_triangles +=
            append_triangles(primitive_.mode, is_mirrored ? Winding::reversed : Winding::kept,
                             primitive_.indices, first, part.mesh);
    }
    return true;
}

bool LevelReader::append_positions(const Affine& frame, const std::string& place, Mesh& mesh) {
    const std::vector<float>& xyz = primitive_.positions;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
        const Vec3 position =
            transform_point(frame, Eigen::Vector3f(xyz[i], xyz[i + 1], xyz[i + 2]).cast<double>());
        if (!is_finite(position) || position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
            return refusal_.refuse(
                place, "expected finite positions within 1e7 m, found another at vertex " +
                           std::to_string(i / 3));
        }
        mesh.positions.push_back(position);
    }
    return true;
}

void LevelReader::begin_color(const gltf::Material* material, LevelPart& part) {
    ColorRun run = {static_cast<std::uint32_t>(part.mesh.triangles.size()), part.mesh.color};
    if (material != nullptr) {
        run.color = material->color;
        run.emissive = material->emissive;
        run.opacity = material->opacity;
        run.gloss = material->gloss;
    }
    part.color_runs.push_back(run);
}

void LevelReader::add_notes() {
    std::vector<std::string> notes = model_.notes;
    if (level_.skipped_primitives > 0) {
        notes.push_back("skipped primitives that are points, lines or without positions: " +
                        std::to_string(level_.skipped_primitives));
    }
    for (const std::string& note : notes) {
        level_.notes.push_back(gltf::note_line(refusal_.file(), note));
    }
}

}  // namespace

Result<GltfLevel> parse_gltf_level(std::string_view bytes, const std::filesystem::path& path) {
    const Result<gltf::Model> model = gltf::parse_model(bytes, path.string());
    if (!model) {
        return model.error();
    }
    gltf::Refusal refusal(path.string());
    gltf::Buffers buffers;
    if (!buffers.load(model.value(), path, refusal)) {
        return refusal.error();
    }
    LevelReader reader(model.value(), buffers.bytes(), refusal);
    if (!reader.read()) {
        return refusal.error();
    }
    return reader.take_level();
}

Result<GltfLevel> load_gltf_level(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return bytes.error();
    }
    return parse_gltf_level(bytes.value(), path);
}

}  // namespace handhold
