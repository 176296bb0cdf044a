#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// The part of a glTF 2.0 document that geometry needs, as plain structs. Field names and meanings
// follow the Khronos specification, section 5. Private to engine/io/gltf*.
namespace handhold::gltf {

constexpr int k_none = -1;  // index of nothing

enum class ComponentType {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

struct Buffer {
    std::uint64_t bytes = 0;
    std::string uri;           // empty: the binary chunk of the .glb
    bool is_fallback = false;  // holds no data (EXT_meshopt_compression)
};

// EXT_meshopt_compression: the compressed bytes of a view.
struct Meshopt {
    enum class Mode { attributes, triangles, indices };
    enum class Filter { none, octahedral, quaternion, exponential };
    int buffer = k_none;
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t stride = 0;  // bytes of a decoded element
    std::uint64_t count = 0;   // decoded elements
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
};

struct BufferView {
    int buffer = k_none;
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t stride = 0;  // 0: elements are tightly packed
    std::optional<Meshopt> meshopt;
};

struct SparseElements {
    std::uint64_t count = 0;
    int indices_view = k_none;
    std::uint64_t indices_offset = 0;
    ComponentType indices_type = ComponentType::uint16;
    int values_view = k_none;
    std::uint64_t values_offset = 0;
};

struct Accessor {
    int view = k_none;  // k_none: all elements are zero
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
    std::size_t components = 1;  // 1 to 4 for SCALAR and VECn, 4, 9 or 16 for MATn
    bool is_matrix = false;
    ComponentType component_type = ComponentType::float32;
    bool is_normalized = false;
    std::optional<SparseElements> sparse;
};

// KHR_draco_mesh_compression: a view with compressed geometry, and Draco's unique id of each
// attribute, by the attribute's name.
struct Draco {
    int view = k_none;
    std::map<std::string, int> attributes;
};

struct Primitive {
    std::map<std::string, int> attributes;  // accessors by name, such as "POSITION"
    int indices = k_none;
    int material = k_none;
    int mode = 4;
    std::optional<Draco> draco;
};

struct Mesh {
    std::string name;
    bool is_synthetic = false;  // extras.synthetic
    std::vector<Primitive> primitives;
};

// All factors are clamped to [0, 1].
struct Material {
    std::array<float, 3> color = {1.0F, 1.0F, 1.0F};
    float opacity = 1.0F;   // less than 1 only if alphaMode is BLEND
    float gloss = 0.0F;     // 1 - roughness
    float emissive = 0.0F;  // multiple of `color`, >= 0; from the brightest channel
};

struct Node {
    std::string name;
    bool is_synthetic = false;  // extras.synthetic
    int mesh = k_none;
    int skin = k_none;
    std::vector<int> children;
    Affine local;  // transform into the parent's frame
    // The members of its extras that are a number or an array of numbers.
    std::map<std::string, std::vector<double>> numbers;
    // EXT_mesh_gpu_instancing: accessors by name ("TRANSLATION", "ROTATION", "SCALE").
    std::optional<std::map<std::string, int>> instances;
};

struct Skin {
    std::vector<int> joints;  // nodes
    int inverse_binds = k_none;
};

struct Model {
    std::vector<Buffer> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<std::vector<int>> scenes;  // root nodes
    int scene = k_none;
    std::string_view binary;         // binary chunk; points into the parsed bytes
    std::vector<std::string> notes;  // remarks about parts that were ignored or clamped
};

// Parses the bytes of a .gltf or .glb, which must outlive the model. Errors: a field of the wrong
// type or out of the specification's range, a required extension that is not supported, and a
// buffer that claims more bytes than the binary chunk has. Does not check indices into other
// sections; the code that uses an index must check it. Reads no other file. `file` is used in
// messages.
Result<Model> parse_model(std::string_view bytes, const std::string& file);

std::string pointer(const char* section, int index);  // "/nodes/3"

// True if `index` is an element of `section`.
template <typename T>
bool has_element(const std::vector<T>& section, int index) {
    return index >= 0 && static_cast<std::size_t>(index) < section.size();
}
// Precondition: has_element(section, index).
template <typename T>
const T& element(const std::vector<T>& section, int index) {
    return section[static_cast<std::size_t>(index)];
}

// Keeps the first error of a file.
class Refusal {
  public:
    explicit Refusal(std::string file) : file_(std::move(file)) {}
    // refuse and refuse_index always return false.
    bool refuse(std::string place, std::string expected);
    bool refuse_index(std::string place, const char* what, std::size_t size, int found);
    // Precondition: an error was reported.
    const FileError& error() const { return error_.value(); }
    const std::string& file() const { return file_; }

  private:
    std::string file_;
    std::optional<FileError> error_;
};

}  // namespace handhold::gltf
