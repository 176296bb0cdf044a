#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/gltf_model.hpp"

namespace handhold::gltf {

// Use of an accessor. It determines the number of components and the allowed component types
// (specification, 3.6.2 and 3.7; KHR_mesh_quantization allows more for `vectors`).
enum class Elements { vectors, quaternions, indices, joints, weights, matrices };
std::size_t components_of(Elements elements);

// Reads accessors, including strided, sparse and normalised ones and those of compressed views
// (EXT_meshopt_compression). Checks every offset, count and stride against the available bytes
// before it allocates. Private to engine/io/gltf*.
class AccessorReader {
  public:
    // All arguments must outlive the reader. `buffers`: the bytes of each of the model's buffers.
    AccessorReader(const Model& model, std::span<const std::string_view> buffers, Refusal& refusal)
        : model_(model), buffers_(buffers), refusal_(refusal), decoded_(model.views.size()) {}

    // Checks that the accessor exists and may be read as `elements`. `place` is the JSON pointer of
    // the reference to the accessor. Every function that returns a bool returns false after an
    // error.
    bool check(int accessor, Elements elements, const std::string& place);
    // Reads components_of(elements) floats per element. Normalised integers are divided by their
    // largest value; weights always are.
    bool read_floats(int accessor, Elements elements, const std::string& place,
                     std::vector<float>& out);
    bool read_indices(int accessor, const std::string& place, std::vector<std::uint32_t>& out);
    // Sets `bytes` to the decompressed bytes of a view, which are valid as long as the reader.
    bool read_view(int view, const std::string& place, std::string_view& bytes);

  private:
    // Elements that lie within `bytes`.
    struct Block {
        std::string_view bytes;  // begins with the first element
        std::size_t stride = 0;
        std::size_t count = 0;
        std::size_t components = 0;
        ComponentType type = ComponentType::float32;
        bool is_normalized = false;
    };

    bool slice(int buffer, std::uint64_t offset, std::uint64_t bytes, const std::string& place,
               std::string_view& out);
    bool decompress(int view, std::string_view& bytes);
    // Fills `bytes` and `stride` of a block whose other fields are set.
    bool find_block(int view, std::uint64_t offset, const std::string& place, Block& block);
    template <typename T>
    static void convert_block(const Block& block, T* out);
    template <typename T>
    bool read(int accessor, Elements elements, const std::string& place, std::vector<T>& out);
    template <typename T>
    bool apply_sparse(const Accessor& accessor, const Block& shape, const std::string& place,
                      std::vector<T>& out);

    const Model& model_;
    std::span<const std::string_view> buffers_;
    Refusal& refusal_;
    std::vector<std::string> decoded_;  // decompressed bytes by view; empty until they are needed
    std::uint64_t decoded_bytes_ = 0;
};

}  // namespace handhold::gltf
