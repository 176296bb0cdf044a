#include "engine/io/gltf.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "engine/io/gltf_document.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/node_tree.hpp"
#include "engine/io/text_file.hpp"
#include "engine/io/triangle_list.hpp"
#include "engine/math/math.hpp"

namespace handhold {

namespace {

bool read_synthetic(const tinygltf::Value& extras) {
    return extras.IsObject() && extras.Has("synthetic") && extras.Get("synthetic").IsBool() &&
           extras.Get("synthetic").Get<bool>();
}

std::optional<TriangleMode> triangle_mode(int gltf_mode) {
    switch (gltf_mode) {
        case TINYGLTF_MODE_TRIANGLES:
            return TriangleMode::list;
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            return TriangleMode::strip;
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return TriangleMode::fan;
        default:
            return std::nullopt;
    }
}

// Reads a model's scene into parts. The first error stops it.
class LevelReader {
  public:
    LevelReader(const tinygltf::Model& model, std::string file)
        : model_(model), reader_(model, std::move(file)) {}

    Result<GltfLevel> read() {
        std::vector<PlacedNode> placed;
        if (!reader_.place_scene(placed)) {
            return reader_.error();
        }
        for (const PlacedNode& node : placed) {
            if (model_.nodes[static_cast<std::size_t>(node.node)].mesh != -1 &&
                !read_part(node.node, node.world)) {
                return reader_.error();
            }
        }
        return std::move(level_);
    }

  private:
    bool refuse(std::string place, std::string expected) {
        return reader_.refuse(std::move(place), std::move(expected));
    }

    bool read_part(int index, const Affine& transform);
    bool read_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                        const Affine& transform, LevelPart& part);
    bool append_positions(const AccessorView& view, const std::string& place,
                          const Affine& transform, Mesh& mesh);
    bool begin_color(int material, const std::string& place, LevelPart& part);

    const tinygltf::Model& model_;
    GltfModelReader reader_;
    GltfLevel level_;
    std::vector<std::uint32_t> indices_;  // scratch of one primitive
    // Of the part being read: where the vertices of a POSITION accessor begin.
    std::map<int, std::uint32_t> first_vertex_;
    std::size_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
};

bool LevelReader::read_part(int index, const Affine& transform) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    const std::string place = gltf_pointer("nodes", index);
    if (node.skin != -1) {
        return refuse(place + "/skin", "expected rigid geometry, found a mesh that follows a skin");
    }
    if (!is_gltf_index(node.mesh, model_.meshes.size())) {
        return reader_.refuse_index(place + "/mesh", "mesh", model_.meshes.size(), node.mesh);
    }
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    LevelPart part;
    part.pointer = place;
    part.mesh.name = !node.name.empty()   ? node.name
                     : !mesh.name.empty() ? mesh.name
                                          : "node " + std::to_string(index);
    part.synthetic = read_synthetic(node.extras) || read_synthetic(mesh.extras);
    first_vertex_.clear();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::string primitive_place =
            gltf_pointer("meshes", node.mesh) + "/primitives/" + std::to_string(i);
        if (!read_primitive(mesh.primitives[i], primitive_place, transform, part)) {
            return false;
        }
    }
    if (!part.color_runs.empty()) {
        part.mesh.color = part.color_runs.front().color;
    }
    level_.parts.push_back(std::move(part));
    return true;
}

bool LevelReader::read_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                                 const Affine& transform, LevelPart& part) {
    const std::optional<TriangleMode> mode = triangle_mode(primitive.mode);
    if (!mode) {
        ++level_.skipped_primitives;
        return true;
    }
    const int position = primitive.attributes.at("POSITION");  // the document check saw it
    const std::string position_place = place + "/attributes/POSITION";
    AccessorView positions;
    if (!reader_.view_accessor(position, GltfElements::vectors, position_place, positions) ||
        !reader_.read_indices(primitive.indices, place + "/indices", positions.count, indices_)) {
        return false;
    }
    const std::size_t triangles = count_triangles(*mode, indices_.size());
    if (triangles == 0) {
        return refuse(place, "expected 3 corners a triangle, found " +
                                 std::to_string(indices_.size()) + " corners");
    }
    triangle_count_ += triangles;
    if (triangle_count_ > k_max_level_size) {
        return refuse(place, "expected at most " + std::to_string(k_max_level_size) +
                                 " triangles in a level");
    }
    // Primitives that share their positions keep sharing them.
    const auto known =
        first_vertex_.emplace(position, static_cast<std::uint32_t>(part.mesh.positions.size()));
    const std::uint32_t first = known.first->second;
    if ((known.second && !append_positions(positions, position_place, transform, part.mesh)) ||
        !begin_color(primitive.material, place + "/material", part)) {
        return false;
    }
    const bool is_mirrored = transform.linear.determinant() < 0.0;
    level_.dropped_triangles += append_triangles(
        *mode, is_mirrored ? Winding::reversed : Winding::kept, indices_, first, part.mesh);
    return true;
}

bool LevelReader::append_positions(const AccessorView& view, const std::string& place,
                                   const Affine& transform, Mesh& mesh) {
    vertex_count_ += view.count;
    if (vertex_count_ > k_max_level_size) {
        return refuse(
            place, "expected at most " + std::to_string(k_max_level_size) + " vertices in a level");
    }
    mesh.positions.reserve(mesh.positions.size() + view.count);
    for (std::size_t i = 0; i < view.count; ++i) {
        Eigen::Vector3f xyz;
        std::memcpy(xyz.data(), view.data + i * view.stride, 3 * sizeof(float));
        const Vec3 position = transform.linear * xyz.cast<double>() + transform.translation;
        if (!is_finite(position) || position.cwiseAbs().maxCoeff() > k_max_level_coordinate_m) {
            return refuse(place,
                          "expected finite positions within 1e7 m, found another at vertex " +
                              std::to_string(i));
        }
        mesh.positions.push_back(position);
    }
    return true;
}

bool LevelReader::begin_color(int material, const std::string& place, LevelPart& part) {
    ColorRun run = {static_cast<std::uint32_t>(part.mesh.triangles.size()), part.mesh.color};
    if (material != -1) {
        if (!is_gltf_index(material, model_.materials.size())) {
            return reader_.refuse_index(place, "material", model_.materials.size(), material);
        }
        read_gltf_material(model_.materials[static_cast<std::size_t>(material)], run);
    }
    part.color_runs.push_back(run);
    return true;
}

}  // namespace

Result<GltfLevel> parse_gltf_level(std::string_view bytes, const std::filesystem::path& path) {
    const Result<std::string> glb = extract_geometry_glb(bytes, path.string());
    if (!glb) {
        return glb.error();
    }
    const Result<tinygltf::Model> model = parse_gltf_model(glb.value(), path);
    if (!model) {
        return model.error();
    }
    return LevelReader(model.value(), path.string()).read();
}

Result<GltfLevel> load_gltf_level(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return bytes.error();
    }
    return parse_gltf_level(bytes.value(), path);
}

}  // namespace handhold
