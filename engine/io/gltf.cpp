#include "engine/io/gltf.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <utility>

// Only the types and the loader: the library is linked, images are never given to it.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "engine/io/gltf_document.hpp"
#include "engine/io/node_tree.hpp"
#include "engine/io/text_file.hpp"
#include "engine/io/triangle_list.hpp"
#include "engine/math/math.hpp"

namespace handhold {

namespace {

// The elements of one accessor; every one of them lies in its buffer.
struct AccessorView {
    const unsigned char* data = nullptr;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::size_t element_bytes = 0;
};

enum class Elements { positions, indices };

// 0 where the accessor's elements are not such.
std::size_t bytes_of_element(Elements elements, const tinygltf::Accessor& accessor) {
    if (elements == Elements::positions) {
        const bool is_known = accessor.type == TINYGLTF_TYPE_VEC3 &&
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
        return is_known ? 3 * sizeof(float) : 0;
    }
    if (accessor.type != TINYGLTF_TYPE_SCALAR) {
        return 0;
    }
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return 4;
        default:
            return 0;
    }
}

std::string pointer_to(const char* section, int index) {
    return std::string("/") + section + "/" + std::to_string(index);
}

bool is_index_of(int index, std::size_t size) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
}

// Our own file access for external buffers: the library would also look in the working directory
// and hand the name to the shell's expansion.
bool is_below_folder(const std::string& name, void* folder) {
    const std::filesystem::path relative = std::filesystem::path(name).lexically_relative(
        *static_cast<std::filesystem::path*>(folder));
    return !relative.empty() && relative.begin()->string() != ".." &&
           std::filesystem::is_regular_file(name);
}

std::string keep_name(const std::string& name, void* /*folder*/) { return name; }

bool read_buffer_file(std::vector<unsigned char>* out, std::string* error, const std::string& name,
                      void* /*folder*/) {
    const Result<std::string> bytes = read_file(name);
    if (!bytes) {
        *error += bytes.error().expected;
        return false;
    }
    out->assign(bytes.value().begin(), bytes.value().end());
    return true;
}

bool write_nothing(std::string* /*error*/, const std::string& /*name*/,
                   const std::vector<unsigned char>& /*bytes*/, void* /*folder*/) {
    return false;
}

bool decode_nothing(tinygltf::Image* /*image*/, int /*index*/, std::string* /*error*/,
                    std::string* /*warning*/, int /*width*/, int /*height*/,
                    const unsigned char* /*bytes*/, int /*size*/, void* /*user*/) {
    return true;
}

Result<tinygltf::Model> parse_model(const std::string& glb, const std::filesystem::path& path) {
    std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(decode_nothing, nullptr);
    loader.SetFsCallbacks({is_below_folder, keep_name, read_buffer_file, write_nothing, &folder});
    tinygltf::Model model;
    std::string error;
    std::string warning;
    bool loaded = false;
    try {
        loaded = loader.LoadBinaryFromMemory(
            &model, &error, &warning, reinterpret_cast<const unsigned char*>(glb.data()),
            static_cast<unsigned int>(glb.size()), folder.string());
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded) {
        constexpr std::size_t k_shown_characters = 200;  // it quotes whole data URIs
        std::replace(error.begin(), error.end(), '\n', ' ');
        return FileError{path.string(), "",
                         "expected glTF 2.0: " + error.substr(0, k_shown_characters)};
    }
    return model;
}

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

void read_material(const tinygltf::Material& material, ColorRun& run) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    float brightest = 0.0F;
    for (std::size_t i = 0; i < run.color.size(); ++i) {
        run.color[i] = static_cast<float>(pbr.baseColorFactor[i]);
        brightest = std::max(brightest, run.color[i]);
    }
    run.gloss = 1.0F - static_cast<float>(pbr.roughnessFactor);
    if (material.alphaMode == "BLEND") {
        run.opacity = static_cast<float>(pbr.baseColorFactor[3]);
    }
    // Ours glows in its own colour: of another one only the brightness is taken.
    const double glow =
        *std::max_element(material.emissiveFactor.begin(), material.emissiveFactor.end());
    double strength = 1.0;
    const auto extension = material.extensions.find("KHR_materials_emissive_strength");
    if (extension != material.extensions.end() && extension->second.Has("emissiveStrength")) {
        strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
    }
    if (brightest > 0.0F) {
        run.emissive = static_cast<float>(glow / static_cast<double>(brightest) * strength);
    }
}

// Reads a model's scene into parts. The first error stops it.
class LevelReader {
  public:
    LevelReader(const tinygltf::Model& model, std::string file)
        : model_(model), file_(std::move(file)) {}

    Result<GltfLevel> read() {
        std::optional<std::vector<int>> roots;
        std::string roots_place;
        std::vector<FileNode> nodes(model_.nodes.size());
        if (!choose_roots(roots, roots_place) || !read_nodes(nodes)) {
            return *std::move(error_);
        }
        const Result<std::vector<PlacedNode>> placed =
            place_nodes(nodes, roots, roots_place, file_);
        if (!placed) {
            return placed.error();
        }
        for (const PlacedNode& node : placed.value()) {
            if (model_.nodes[static_cast<std::size_t>(node.node)].mesh != -1 &&
                !read_part(node.node, node.world)) {
                return *std::move(error_);
            }
        }
        return std::move(level_);
    }

  private:
    bool refuse(std::string place, std::string expected) {
        error_ = FileError{file_, std::move(place), std::move(expected)};
        return false;
    }

    bool refuse_index(const std::string& place, const char* what, std::size_t size, int found) {
        return refuse(place, std::string("expected a ") + what + " below " + std::to_string(size) +
                                 ", found " + std::to_string(found));
    }

    // Leaves `roots` without a value where the file has no scene: then all of it is one.
    bool choose_roots(std::optional<std::vector<int>>& roots, std::string& place);
    bool read_nodes(std::vector<FileNode>& nodes);
    bool read_transform(int index, Affine& transform);
    bool read_part(int index, const Affine& transform);
    bool read_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                        const Affine& transform, LevelPart& part);
    bool read_indices(int accessor, const std::string& place, std::size_t vertices);
    bool append_positions(const AccessorView& view, const std::string& place,
                          const Affine& transform, Mesh& mesh);
    bool begin_color(int material, const std::string& place, LevelPart& part);
    bool view_accessor(int index, Elements elements, const std::string& place, AccessorView& view);
    bool view_bytes(int index, const std::string& place, std::span<const unsigned char>& bytes);

    const tinygltf::Model& model_;
    std::string file_;
    std::optional<FileError> error_;
    GltfLevel level_;
    std::vector<std::uint32_t> indices_;  // scratch of one primitive
    // Of the part being read: where the vertices of a POSITION accessor begin.
    std::map<int, std::uint32_t> first_vertex_;
    std::size_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
};

bool LevelReader::choose_roots(std::optional<std::vector<int>>& roots, std::string& place) {
    if (model_.scenes.empty() && model_.defaultScene == -1) {
        return true;
    }
    const int scene = std::max(model_.defaultScene, 0);
    if (!is_index_of(scene, model_.scenes.size())) {
        return refuse_index("/scene", "scene", model_.scenes.size(), scene);
    }
    roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    place = pointer_to("scenes", scene) + "/nodes";
    return true;
}

bool LevelReader::read_nodes(std::vector<FileNode>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].children = model_.nodes[i].children;
        if (!read_transform(static_cast<int>(i), nodes[i].local)) {
            return false;
        }
    }
    return true;
}

bool LevelReader::read_transform(int index, Affine& transform) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    if (node.matrix.size() == 16) {
        const std::vector<double>& m = node.matrix;  // column by column
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            return refuse(pointer_to("nodes", index) + "/matrix",
                          "expected a last row of 0, 0, 0, 1");
        }
        transform.linear << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
        transform.translation = Vec3(m[12], m[13], m[14]);
        return true;
    }
    if (node.rotation.size() == 4) {
        const Quat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        transform.linear = rotation.normalized().toRotationMatrix();
    }
    if (node.scale.size() == 3) {
        const Vec3 scale(node.scale[0], node.scale[1], node.scale[2]);
        transform.linear = (transform.linear * scale.asDiagonal()).eval();
    }
    if (node.translation.size() == 3) {
        transform.translation = Vec3(node.translation[0], node.translation[1], node.translation[2]);
    }
    return true;
}

bool LevelReader::read_part(int index, const Affine& transform) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    const std::string place = pointer_to("nodes", index);
    if (node.skin != -1) {
        return refuse(place + "/skin", "expected rigid geometry, found a mesh that follows a skin");
    }
    if (!is_index_of(node.mesh, model_.meshes.size())) {
        return refuse_index(place + "/mesh", "mesh", model_.meshes.size(), node.mesh);
    }
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    LevelPart part;
    part.mesh.name = !node.name.empty()   ? node.name
                     : !mesh.name.empty() ? mesh.name
                                          : "node " + std::to_string(index);
    part.synthetic = read_synthetic(node.extras) || read_synthetic(mesh.extras);
    first_vertex_.clear();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::string primitive_place =
            pointer_to("meshes", node.mesh) + "/primitives/" + std::to_string(i);
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
    if (!view_accessor(position, Elements::positions, position_place, positions) ||
        !read_indices(primitive.indices, place + "/indices", positions.count)) {
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

// Into indices_: those of the accessor, or 0, 1, 2, ... where there is none.
bool LevelReader::read_indices(int accessor, const std::string& place, std::size_t vertices) {
    indices_.clear();
    if (vertices > k_max_level_size) {
        return refuse(place, "expected at most " + std::to_string(k_max_level_size) + " vertices");
    }
    if (accessor == -1) {
        for (std::uint32_t i = 0; i < vertices; ++i) {
            indices_.push_back(i);
        }
        return true;
    }
    AccessorView view;
    if (!view_accessor(accessor, Elements::indices, place, view)) {
        return false;
    }
    if (view.count > 3 * k_max_level_size) {
        return refuse(place,
                      "expected at most " + std::to_string(3 * k_max_level_size) + " indices");
    }
    indices_.reserve(view.count);
    for (std::size_t i = 0; i < view.count; ++i) {
        std::uint32_t index = 0;
        for (std::size_t byte = 0; byte < view.element_bytes; ++byte) {
            index |= std::uint32_t{view.data[i * view.stride + byte]} << (8 * byte);
        }
        if (index >= vertices) {
            return refuse(place, "expected indices below " + std::to_string(vertices) + ", found " +
                                     std::to_string(index) + " at " + std::to_string(i));
        }
        indices_.push_back(index);
    }
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
        if (!is_index_of(material, model_.materials.size())) {
            return refuse_index(place, "material", model_.materials.size(), material);
        }
        read_material(model_.materials[static_cast<std::size_t>(material)], run);
    }
    part.color_runs.push_back(run);
    return true;
}

// What the specification (3.6.2.4) asks of an accessor and its view before a single byte is read
// through them. The document check keeps every number here below 2^32: no sum or product overflows.
bool LevelReader::view_accessor(int index, Elements elements, const std::string& place,
                                AccessorView& view) {
    if (!is_index_of(index, model_.accessors.size())) {
        return refuse_index(place, "accessor", model_.accessors.size(), index);
    }
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    const std::string accessor_place = pointer_to("accessors", index);
    const std::size_t element_bytes = bytes_of_element(elements, accessor);
    if (element_bytes == 0) {
        return refuse(accessor_place, elements == Elements::positions
                                          ? "expected VEC3 of float for positions"
                                          : "expected SCALAR of unsigned integer for indices");
    }
    std::span<const unsigned char> bytes;
    if (!view_bytes(accessor.bufferView, accessor_place + "/bufferView", bytes)) {
        return false;
    }
    const std::size_t file_stride =
        model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = file_stride == 0 ? element_bytes : file_stride;
    if (stride < element_bytes) {
        return refuse(pointer_to("bufferViews", accessor.bufferView) + "/byteStride",
                      "expected at least the " + std::to_string(element_bytes) +
                          " bytes of an element, found " + std::to_string(stride));
    }
    const std::size_t end = accessor.byteOffset + stride * (accessor.count - 1) + element_bytes;
    if (end > bytes.size()) {
        return refuse(accessor_place,
                      "expected elements within the " + std::to_string(bytes.size()) +
                          " bytes of the view, found an end at " + std::to_string(end));
    }
    view = {bytes.data() + accessor.byteOffset, accessor.count, stride, element_bytes};
    return true;
}

bool LevelReader::view_bytes(int index, const std::string& place,
                             std::span<const unsigned char>& bytes) {
    if (!is_index_of(index, model_.bufferViews.size())) {
        return refuse_index(place, "buffer view", model_.bufferViews.size(), index);
    }
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    const std::string view_place = pointer_to("bufferViews", index);
    if (!is_index_of(view.buffer, model_.buffers.size())) {
        return refuse_index(view_place + "/buffer", "buffer", model_.buffers.size(), view.buffer);
    }
    const std::vector<unsigned char>& all =
        model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset + view.byteLength > all.size()) {
        return refuse(view_place, "expected a view within the " + std::to_string(all.size()) +
                                      " bytes of its buffer, found an end at " +
                                      std::to_string(view.byteOffset + view.byteLength));
    }
    bytes = std::span(all).subspan(view.byteOffset, view.byteLength);
    return true;
}

}  // namespace

Result<GltfLevel> parse_gltf_level(std::string_view bytes, const std::filesystem::path& path) {
    const Result<std::string> glb = extract_geometry_glb(bytes, path.string());
    if (!glb) {
        return glb.error();
    }
    const Result<tinygltf::Model> model = parse_model(glb.value(), path);
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
