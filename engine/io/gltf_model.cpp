#include "engine/io/gltf_model.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "engine/io/text_file.hpp"
#include "engine/math/math.hpp"

namespace handhold {

namespace {

// What accessors of each use may hold (specification, 3.7.2.1 and 3.7.3).
struct ElementRule {
    int type;
    std::size_t components;
    bool is_float, is_byte, is_short, is_int;  // which are allowed, the integers unsigned
    const char* expected;
};

ElementRule rule_of(GltfElements elements) {
    switch (elements) {
        case GltfElements::vectors:
            return {TINYGLTF_TYPE_VEC3, 3, true, false, false, false, "expected VEC3 of float"};
        case GltfElements::indices:
            return {TINYGLTF_TYPE_SCALAR,
                    1,
                    false,
                    true,
                    true,
                    true,
                    "expected SCALAR of unsigned integer for indices"};
        case GltfElements::joints:
            return {TINYGLTF_TYPE_VEC4,
                    4,
                    false,
                    true,
                    true,
                    false,
                    "expected VEC4 of unsigned byte or short for joints"};
        case GltfElements::weights:
            return {TINYGLTF_TYPE_VEC4,
                    4,
                    true,
                    true,
                    true,
                    false,
                    "expected VEC4 of float, unsigned byte or short for weights"};
        case GltfElements::matrices:
            break;
    }
    return {TINYGLTF_TYPE_MAT4, 16, true, false, false, false, "expected MAT4 of float"};
}

// 0 where the accessor's elements are not such.
std::size_t bytes_of_element(const ElementRule& rule, const tinygltf::Accessor& accessor) {
    if (accessor.type != rule.type) {
        return 0;
    }
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return rule.is_float ? 4 * rule.components : 0;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return rule.is_byte ? rule.components : 0;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return rule.is_short ? 2 * rule.components : 0;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return rule.is_int ? 4 * rule.components : 0;
        default:
            return 0;
    }
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

}  // namespace

std::string gltf_pointer(const char* section, int index) {
    return std::string("/") + section + "/" + std::to_string(index);
}

bool is_gltf_index(int index, std::size_t size) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
}

Result<tinygltf::Model> parse_gltf_model(const std::string& glb,
                                         const std::filesystem::path& path) {
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

void read_gltf_material(const tinygltf::Material& material, ColorRun& run) {
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

float read_gltf_float(const AccessorView& view, std::size_t element, std::size_t component) {
    float value = 0.0F;
    std::memcpy(&value, view.data + element * view.stride + component * sizeof(float),
                sizeof(float));
    return value;
}

Vec3 read_gltf_vector(const AccessorView& view, std::size_t element) {
    return {static_cast<double>(read_gltf_float(view, element, 0)),
            static_cast<double>(read_gltf_float(view, element, 1)),
            static_cast<double>(read_gltf_float(view, element, 2))};
}

std::uint32_t read_gltf_unsigned(const AccessorView& view, std::size_t element,
                                 std::size_t component) {
    const std::size_t bytes = view.element_bytes / 4;  // of four components
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
        value |= std::uint32_t{view.data[element * view.stride + component * bytes + i]} << (8 * i);
    }
    return value;
}

// Integers are shares of their greatest value (specification, 3.6.2.2).
float read_gltf_share(const AccessorView& view, std::size_t element, std::size_t component) {
    switch (view.component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return static_cast<float>(read_gltf_unsigned(view, element, component)) / 255.0F;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return static_cast<float>(read_gltf_unsigned(view, element, component)) / 65535.0F;
        default:
            return read_gltf_float(view, element, component);
    }
}

// What is neither a number nor an array of numbers is somebody else's.
std::map<std::string, std::vector<double>> read_gltf_numbers(const tinygltf::Value& extras) {
    std::map<std::string, std::vector<double>> numbers;
    if (!extras.IsObject()) {
        return numbers;
    }
    for (const std::string& key : extras.Keys()) {
        const tinygltf::Value& value = extras.Get(key);
        std::vector<double> list;
        bool is_numbers = value.IsNumber() || value.IsArray();
        if (value.IsNumber()) {
            list.push_back(value.GetNumberAsDouble());
        }
        for (std::size_t i = 0; value.IsArray() && i < value.ArrayLen(); ++i) {
            const tinygltf::Value& item = value.Get(static_cast<int>(i));
            is_numbers = is_numbers && item.IsNumber();
            list.push_back(item.IsNumber() ? item.GetNumberAsDouble() : 0.0);
        }
        if (is_numbers) {
            numbers.emplace(key, std::move(list));
        }
    }
    return numbers;
}

bool GltfModelReader::refuse(std::string place, std::string expected) {
    error_ = FileError{file_, std::move(place), std::move(expected)};
    return false;
}

bool GltfModelReader::refuse_index(const std::string& place, const char* what, std::size_t size,
                                   int found) {
    return refuse(place, std::string("expected a ") + what + " below " + std::to_string(size) +
                             ", found " + std::to_string(found));
}

bool GltfModelReader::place_scene(std::vector<PlacedNode>& placed) {
    std::optional<std::vector<int>> roots;
    std::string roots_place;
    std::vector<FileNode> nodes(model_.nodes.size());
    if (!choose_roots(roots, roots_place) || !read_nodes(nodes)) {
        return false;
    }
    Result<std::vector<PlacedNode>> found = place_nodes(nodes, roots, roots_place, file_);
    if (!found) {
        error_ = found.error();
        return false;
    }
    placed = std::move(found.value());
    return true;
}

bool GltfModelReader::choose_roots(std::optional<std::vector<int>>& roots, std::string& place) {
    if (model_.scenes.empty() && model_.defaultScene == -1) {
        return true;
    }
    const int scene = std::max(model_.defaultScene, 0);
    if (!is_gltf_index(scene, model_.scenes.size())) {
        return refuse_index("/scene", "scene", model_.scenes.size(), scene);
    }
    roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    place = gltf_pointer("scenes", scene) + "/nodes";
    return true;
}

bool GltfModelReader::read_nodes(std::vector<FileNode>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].children = model_.nodes[i].children;
        if (!read_transform(static_cast<int>(i), nodes[i].local)) {
            return false;
        }
    }
    return true;
}

bool GltfModelReader::read_transform(int index, Affine& transform) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    if (node.matrix.size() == 16) {
        const std::vector<double>& m = node.matrix;  // column by column
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            return refuse(gltf_pointer("nodes", index) + "/matrix",
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

bool GltfModelReader::read_indices(int accessor, const std::string& place, std::size_t vertices,
                                   std::vector<std::uint32_t>& out) {
    out.clear();
    if (vertices > k_max_level_size) {
        return refuse(place, "expected at most " + std::to_string(k_max_level_size) + " vertices");
    }
    if (accessor == -1) {
        for (std::uint32_t i = 0; i < vertices; ++i) {
            out.push_back(i);
        }
        return true;
    }
    AccessorView view;
    if (!view_accessor(accessor, GltfElements::indices, place, view)) {
        return false;
    }
    if (view.count > 3 * k_max_level_size) {
        return refuse(place,
                      "expected at most " + std::to_string(3 * k_max_level_size) + " indices");
    }
    out.reserve(view.count);
    for (std::size_t i = 0; i < view.count; ++i) {
        std::uint32_t index = 0;
        for (std::size_t byte = 0; byte < view.element_bytes; ++byte) {
            index |= std::uint32_t{view.data[i * view.stride + byte]} << (8 * byte);
        }
        if (index >= vertices) {
            return refuse(place, "expected indices below " + std::to_string(vertices) + ", found " +
                                     std::to_string(index) + " at " + std::to_string(i));
        }
        out.push_back(index);
    }
    return true;
}

// What the specification (3.6.2.4) asks of an accessor and its view before a single byte is read
// through them. The document check keeps every number here below 2^32: no sum or product overflows.
bool GltfModelReader::view_accessor(int index, GltfElements elements, const std::string& place,
                                    AccessorView& view) {
    if (!is_gltf_index(index, model_.accessors.size())) {
        return refuse_index(place, "accessor", model_.accessors.size(), index);
    }
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    const std::string accessor_place = gltf_pointer("accessors", index);
    const ElementRule rule = rule_of(elements);
    const std::size_t element_bytes = bytes_of_element(rule, accessor);
    if (element_bytes == 0) {
        return refuse(accessor_place, rule.expected);
    }
    std::span<const unsigned char> bytes;
    if (!view_bytes(accessor.bufferView, accessor_place + "/bufferView", bytes)) {
        return false;
    }
    const std::size_t file_stride =
        model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = file_stride == 0 ? element_bytes : file_stride;
    if (stride < element_bytes) {
        return refuse(gltf_pointer("bufferViews", accessor.bufferView) + "/byteStride",
                      "expected at least the " + std::to_string(element_bytes) +
                          " bytes of an element, found " + std::to_string(stride));
    }
    const std::size_t end = accessor.byteOffset + stride * (accessor.count - 1) + element_bytes;
    if (end > bytes.size()) {
        return refuse(accessor_place,
                      "expected elements within the " + std::to_string(bytes.size()) +
                          " bytes of the view, found an end at " + std::to_string(end));
    }
    view = {bytes.data() + accessor.byteOffset, accessor.count, stride, element_bytes,
            accessor.componentType};
    return true;
}

bool GltfModelReader::view_bytes(int index, const std::string& place,
                                 std::span<const unsigned char>& bytes) {
    if (!is_gltf_index(index, model_.bufferViews.size())) {
        return refuse_index(place, "buffer view", model_.bufferViews.size(), index);
    }
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    const std::string view_place = gltf_pointer("bufferViews", index);
    if (!is_gltf_index(view.buffer, model_.buffers.size())) {
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

}  // namespace handhold
