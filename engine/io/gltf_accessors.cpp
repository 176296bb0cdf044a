#include "engine/io/gltf_accessors.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_meshopt.hpp"

namespace handhold::gltf {
namespace {

std::size_t bytes_of(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::uint8:
            return 1;
        case ComponentType::int16:
        case ComponentType::uint16:
            return 2;
        case ComponentType::uint32:
        case ComponentType::float32:
            break;
    }
    return 4;
}

struct Rule {
    std::size_t components;
    bool is_matrix;
    bool allows_float, allows_signed, allows_short_unsigned, allows_uint32;
    const char* expected;
};

Rule rule_of(Elements elements) {
    switch (elements) {
        case Elements::vectors:
            return {3, false, true, true, true, false, "expected VEC3 of float, byte or short"};
        case Elements::quaternions:
            return {4, false, true, true, false, false, "expected VEC4 of float, byte or short"};
        case Elements::indices:
            return {1,
                    false,
                    false,
                    false,
                    true,
                    true,
                    "expected SCALAR of unsigned integer for indices"};
        case Elements::joints:
            return {4,
                    false,
                    false,
                    false,
                    true,
                    false,
                    "expected VEC4 of unsigned byte or short for joints"};
        case Elements::weights:
            return {4,
                    false,
                    true,
                    false,
                    true,
                    false,
                    "expected VEC4 of float, unsigned byte or short for weights"};
        case Elements::matrices:
            break;
    }
    return {16, true, true, false, false, false, "expected MAT4 of float"};
}

bool allows(const Rule& rule, ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::int16:
            return rule.allows_signed;
        case ComponentType::uint8:
        case ComponentType::uint16:
            return rule.allows_short_unsigned;
        case ComponentType::uint32:
            return rule.allows_uint32;
        case ComponentType::float32:
            break;
    }
    return rule.allows_float;
}

// Converts `count` elements of `components` values of type From. Normalised integers become max(n /
// largest, -1) (specification, 3.6.2.2).
template <typename From, typename To>
void convert(const char* from, std::size_t stride, std::size_t count, std::size_t components,
             bool is_normalized, To* to) {
    for (std::size_t i = 0; i < count; ++i, from += stride) {
        for (std::size_t k = 0; k < components; ++k) {
            From value;
            std::memcpy(&value, from + k * sizeof(From), sizeof(From));
            if constexpr (std::is_integral_v<From> && std::is_floating_point_v<To>) {
                constexpr To k_largest = static_cast<To>(std::numeric_limits<From>::max());
                *to++ = is_normalized ? std::max(static_cast<To>(value) / k_largest, To{-1})
                                      : static_cast<To>(value);
            } else {
                // NOLINTNEXTLINE(bugprone-signed-char-misuse): indices are unsigned
                *to++ = static_cast<To>(value);
            }
        }
    }
}

}  // namespace

template <typename T>
void AccessorReader::convert_block(const Block& block, T* out) {
    const auto run = [&]<typename From>(From /*type*/) {
        convert<From>(block.bytes.data(), block.stride, block.count, block.components,
                      block.is_normalized, out);
    };
    switch (block.type) {
        case ComponentType::int8:
            return run(std::int8_t{});
        case ComponentType::uint8:
            return run(std::uint8_t{});
        case ComponentType::int16:
            return run(std::int16_t{});
        case ComponentType::uint16:
            return run(std::uint16_t{});
        case ComponentType::uint32:
            return run(std::uint32_t{});
        case ComponentType::float32:
            return run(float{});
    }
}

std::size_t components_of(Elements elements) { return rule_of(elements).components; }

bool AccessorReader::check(int accessor, Elements elements, const std::string& place) {
    if (!has_element(model_.accessors, accessor)) {
        return refusal_.refuse_index(place, "accessor", model_.accessors.size(), accessor);
    }
    const Accessor& found = element(model_.accessors, accessor);
    const Rule rule = rule_of(elements);
    return (found.components == rule.components && found.is_matrix == rule.is_matrix &&
            allows(rule, found.component_type)) ||
           refusal_.refuse(pointer("accessors", accessor), rule.expected);
}

bool AccessorReader::read_floats(int accessor, Elements elements, const std::string& place,
                                 std::vector<float>& out) {
    return read(accessor, elements, place, out);
}

bool AccessorReader::read_indices(int accessor, const std::string& place,
                                  std::vector<std::uint32_t>& out) {
    return read(accessor, Elements::indices, place, out);
}

bool AccessorReader::slice(int buffer, std::uint64_t offset, std::uint64_t bytes,
                           const std::string& place, std::string_view& out) {
    if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers_.size()) {
        return refusal_.refuse_index(place + "/buffer", "buffer", buffers_.size(), buffer);
    }
    const std::string_view all = buffers_[static_cast<std::size_t>(buffer)];
    if (offset + bytes > all.size()) {
        return refusal_.refuse(place, "expected a view within the " + std::to_string(all.size()) +
                                          " bytes of its buffer, found an end at " +
                                          std::to_string(offset + bytes));
    }
    out = all.substr(offset, bytes);
    return true;
}

bool AccessorReader::decompress(int view, std::string_view& bytes) {
    const Meshopt& meshopt = *element(model_.views, view).meshopt;
    const std::string place = pointer("bufferViews", view) + "/extensions/EXT_meshopt_compression";
    std::string& decoded = decoded_[static_cast<std::size_t>(view)];
    if (decoded.empty()) {
        std::string_view compressed;
        if (!slice(meshopt.buffer, meshopt.offset, meshopt.bytes, place, compressed)) {
            return false;
        }
        decoded_bytes_ += meshopt.stride * meshopt.count;
        if (decoded_bytes_ > k_max_file_bytes) {
            return refusal_.refuse(place, "expected at most " + std::to_string(k_max_file_bytes) +
                                              " bytes in all decompressed views");
        }
        std::optional<std::string> result = decode_meshopt(meshopt, compressed);
        if (!result) {
            return refusal_.refuse(place, "expected " + std::to_string(meshopt.count) +
                                              " compressed elements, found malformed data");
        }
        decoded = *std::move(result);
    }
    bytes = decoded;
    return true;
}

bool AccessorReader::read_view(int view, const std::string& place, std::string_view& bytes) {
    if (!has_element(model_.views, view)) {
        return refusal_.refuse_index(place, "buffer view", model_.views.size(), view);
    }
    const BufferView& found = element(model_.views, view);
    return found.meshopt ? decompress(view, bytes)
                         : slice(found.buffer, found.offset, found.bytes,
                                 pointer("bufferViews", view), bytes);
}

// See the specification, 3.6.2.4. The parser keeps every number below 2^32, so nothing overflows.
bool AccessorReader::find_block(int view, std::uint64_t offset, const std::string& place,
                                Block& block) {
    if (!read_view(view, place + "/bufferView", block.bytes)) {
        return false;
    }
    const std::size_t element_bytes = block.components * bytes_of(block.type);
    const std::size_t file_stride = element(model_.views, view).stride;
    block.stride = file_stride == 0 ? element_bytes : file_stride;
    if (block.stride < element_bytes) {
        return refusal_.refuse(pointer("bufferViews", view) + "/byteStride",
                               "expected at least the " + std::to_string(element_bytes) +
                                   " bytes of an element, found " + std::to_string(block.stride));
    }
    const std::uint64_t end =
        offset + std::uint64_t{block.stride} * (block.count - 1) + element_bytes;
    if (end > block.bytes.size()) {
        return refusal_.refuse(
            place, "expected elements within the " + std::to_string(block.bytes.size()) +
                       " bytes of the view, found an end at " + std::to_string(end));
    }
    block.bytes.remove_prefix(offset);
    return true;
}

template <typename T>
bool AccessorReader::read(int accessor, Elements elements, const std::string& place,
                          std::vector<T>& out) {
    if (!check(accessor, elements, place)) {
        return false;
    }
    const Accessor& found = element(model_.accessors, accessor);
    const std::string accessor_place = pointer("accessors", accessor);
    Block block{{},
                0,
                static_cast<std::size_t>(found.count),
                found.components,
                found.component_type,
                found.is_normalized || elements == Elements::weights};
    if (found.view == k_none) {
        // An accessor without a view is all zeros and takes no bytes in the file. This limit keeps
        // the memory in proportion to the file.
        const std::uint64_t file_bytes = std::accumulate(
            buffers_.begin(), buffers_.end(), std::uint64_t{0},
            [](std::uint64_t sum, std::string_view bytes) { return sum + bytes.size(); });
        if (found.count > file_bytes) {
            return refusal_.refuse(accessor_place + "/bufferView", "expected a buffer view for " +
                                                                       std::to_string(found.count) +
                                                                       " elements, found none");
        }
        out.assign(found.count * found.components, T{});
    } else {
        if (!find_block(found.view, found.offset, accessor_place, block)) {
            return false;
        }
        out.resize(found.count * found.components);
        convert_block(block, out.data());
    }
    return !found.sparse || apply_sparse(found, block, accessor_place + "/sparse", out);
}

template <typename T>
bool AccessorReader::apply_sparse(const Accessor& accessor, const Block& shape,
                                  const std::string& place, std::vector<T>& out) {
    const SparseElements& sparse = *accessor.sparse;
    if (sparse.count > accessor.count) {
        return refusal_.refuse(place + "/count", "expected at most " +
                                                     std::to_string(accessor.count) + ", found " +
                                                     std::to_string(sparse.count));
    }
    if (!allows(rule_of(Elements::indices), sparse.indices_type)) {
        return refusal_.refuse(place + "/indices/componentType", "expected an unsigned integer");
    }
    Block places{{}, 0, static_cast<std::size_t>(sparse.count), 1, sparse.indices_type, false};
    Block values = shape;
    values.count = sparse.count;
    if (!find_block(sparse.indices_view, sparse.indices_offset, place + "/indices", places) ||
        !find_block(sparse.values_view, sparse.values_offset, place + "/values", values)) {
        return false;
    }
    std::vector<std::uint32_t> indices(sparse.count);
    std::vector<T> replacements(sparse.count * shape.components);
    convert_block(places, indices.data());
    convert_block(values, replacements.data());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= accessor.count || (i > 0 && indices[i] <= indices[i - 1])) {
            return refusal_.refuse(place + "/indices", "expected ascending indices below " +
                                                           std::to_string(accessor.count) +
                                                           ", found " + std::to_string(indices[i]) +
                                                           " at " + std::to_string(i));
        }
        std::copy_n(replacements.begin() + static_cast<std::ptrdiff_t>(i * shape.components),
                    shape.components,
                    out.begin() + static_cast<std::ptrdiff_t>(indices[i] * shape.components));
    }
    return true;
}

}  // namespace handhold::gltf
