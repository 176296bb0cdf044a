#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Only the types and the loader: the library is linked, images are never given to it.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "engine/io/gltf.hpp"
#include "engine/io/gltf_document.hpp"
#include "engine/io/node_tree.hpp"
#include "engine/io/result.hpp"

// What the readers of glTF share. Included by engine/io/gltf*.cpp only: it names the library.
namespace handhold {

// Of bytes that extract_geometry_glb has passed. `path` is for messages and for external buffers.
Result<tinygltf::Model> parse_gltf_model(const std::string& glb, const std::filesystem::path& path);

std::string gltf_pointer(const char* section, int index);  // "/nodes/3"
bool is_gltf_index(int index, std::size_t size);
// Colour, gloss and what glows of a material.
void read_gltf_material(const tinygltf::Material& material, ColorRun& run);

// The elements of one accessor; every one of them lies in its buffer.
struct AccessorView {
    const unsigned char* data = nullptr;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::size_t element_bytes = 0;
    int component_type = 0;
};

// One component of an element of floats, and three of them.
float read_gltf_float(const AccessorView& view, std::size_t element, std::size_t component);
Vec3 read_gltf_vector(const AccessorView& view, std::size_t element);
// One of four unsigned integers.
std::uint32_t read_gltf_unsigned(const AccessorView& view, std::size_t element,
                                 std::size_t component);
// One of four weights: a float, or an integer that is a share of its greatest value.
float read_gltf_share(const AccessorView& view, std::size_t element, std::size_t component);

// Of an object's extras, those that are a number or an array of numbers.
std::map<std::string, std::vector<double>> read_gltf_numbers(const tinygltf::Value& extras);

// What an accessor is asked to hold.
enum class GltfElements { vectors, indices, joints, weights, matrices };

// Reads parts of a model. The first error stops it: what returns a bool is false from then on.
class GltfModelReader {
  public:
    GltfModelReader(const tinygltf::Model& model, std::string file)
        : model_(model), file_(std::move(file)) {}

    // False, always.
    bool refuse(std::string place, std::string expected);
    bool refuse_index(const std::string& place, const char* what, std::size_t size, int found);
    // Precondition: something was refused.
    FileError error() const { return error_.value(); }

    // The nodes of the default scene (else of the first one, else all), parents before children.
    bool place_scene(std::vector<PlacedNode>& placed);
    // Precondition: `index` is an accessor's number or not; the document check saw an integer.
    bool view_accessor(int index, GltfElements elements, const std::string& place,
                       AccessorView& view);
    // The indices of an accessor, or 0, 1, 2, ... below `vertices` where there is none (-1).
    bool read_indices(int accessor, const std::string& place, std::size_t vertices,
                      std::vector<std::uint32_t>& out);

  private:
    // Leaves `roots` without a value where the file has no scene: then all of it is one.
    bool choose_roots(std::optional<std::vector<int>>& roots, std::string& place);
    bool read_nodes(std::vector<FileNode>& nodes);
    bool read_transform(int index, Affine& transform);
    bool view_bytes(int index, const std::string& place, std::span<const unsigned char>& bytes);

    const tinygltf::Model& model_;
    std::string file_;
    std::optional<FileError> error_;
};

}  // namespace handhold
