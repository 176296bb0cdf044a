#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <meshoptimizer.h>

#include "engine/math/math.hpp"
#include "tests/engine/io/gltf_builder.hpp"
#include "tests/random.hpp"

// Writes geometry in the encodings that glTF allows: quantised, sparse and compressed. Written from
// the specifications; shares no code with the reader.
namespace handhold::test {

// A height field: a manifold whose triangles have area.
struct RandomMesh {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;

    explicit RandomMesh(Random& random) {
        const auto wide = static_cast<std::uint32_t>(random.between(2, 9));
        const auto deep = static_cast<std::uint32_t>(random.between(2, 9));
        const Vec3 size{random.between(0.1, 20), random.between(0.1, 3), random.between(0.1, 20)};
        for (std::uint32_t z = 0; z < deep; ++z) {
            for (std::uint32_t x = 0; x < wide; ++x) {
                positions.push_back(size.cwiseProduct(Vec3(x, random.between(-1, 1), z)));
            }
        }
        for (std::uint32_t z = 0; z + 1 < deep; ++z) {
            for (std::uint32_t x = 0; x + 1 < wide; ++x) {
                const std::uint32_t a = z * wide + x;
                indices.insert(indices.end(), {a, a + wide, a + 1, a + 1, a + wide, a + wide + 1});
            }
        }
    }
};

// Elements of numbers of one component type, as they are in the buffer. Elements are padded to a
// multiple of 4 bytes, as the specification asks of vertex attributes.
struct EncodedElements {
    std::string bytes;
    std::size_t element_bytes = 0;  // with padding
    std::size_t count = 0;
    int component_type = 5126;
    bool is_normalized = false;

    std::string_view element(std::size_t i) const {
        return std::string_view(bytes).substr(i * element_bytes, element_bytes);
    }
};

// Largest value of an integer component type.
inline double largest_of(int component_type) {
    switch (component_type) {
        case 5120:
            return 127;
        case 5121:
            return 255;
        case 5122:
            return 32767;
        default:
            return 65535;
    }
}
inline std::size_t bytes_of(int component_type) {
    return component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4;
}

// Appends a float or, for an integer type, the nearest integer; little-endian.
inline void append_component(std::string& bytes, int component_type, double value) {
    if (component_type == 5126) {
        const auto single = static_cast<float>(value);
        bytes.append(reinterpret_cast<const char*>(&single), 4);
        return;
    }
    const auto integer = static_cast<std::int32_t>(std::lround(value));
    bytes.append(reinterpret_cast<const char*>(&integer), bytes_of(component_type));
}

template <typename Elements>
EncodedElements encode_elements(const Elements& elements, int component_type, bool is_normalized) {
    EncodedElements encoded;
    encoded.component_type = component_type;
    encoded.is_normalized = is_normalized;
    encoded.count = elements.size();
    for (const auto& element : elements) {
        const std::size_t begin = encoded.bytes.size();
        for (std::size_t k = 0; k < static_cast<std::size_t>(element.size()); ++k) {
            append_component(
                encoded.bytes, component_type,
                static_cast<double>(element[static_cast<decltype(element.size())>(k)]));
        }
        encoded.bytes.append((4 - encoded.bytes.size() % 4) % 4, '\0');
        encoded.element_bytes = encoded.bytes.size() - begin;
    }
    return encoded;
}

// Positions in a random component type, and the map that undoes the quantisation.
struct QuantizedPositions {
    EncodedElements elements;
    double scale = 1.0;
    Vec3 offset = Vec3::Zero();
    double tolerance_m = 0.0;  // half a quantisation step, and rounding to float
};

inline QuantizedPositions quantize(const std::vector<Vec3>& positions, Random& random) {
    constexpr std::array<int, 5> k_types = {5126, 5120, 5121, 5122, 5123};
    const int type = k_types[static_cast<std::size_t>(random.between(0, 4.999))];
    const bool is_normalized = type != 5126 && random.between(0, 1) < 0.5;
    Vec3 low = positions.front();
    Vec3 high = low;
    for (const Vec3& position : positions) {
        low = low.cwiseMin(position);
        high = high.cwiseMax(position);
    }
    QuantizedPositions quantized;
    std::vector<Vec3> elements = positions;
    double step_m = 0.0;
    if (type != 5126) {
        const bool is_signed = type == 5120 || type == 5122;
        const double largest = largest_of(type);
        step_m = (high - low).maxCoeff() / (is_signed ? 2.0 * largest : largest);
        quantized.offset = is_signed ? Vec3(0.5 * (low + high)) : low;
        quantized.scale = is_normalized ? step_m * largest : step_m;
        for (Vec3& element : elements) {
            element = (element - quantized.offset) / step_m;
            element = element.cwiseMax(is_signed ? -largest : 0.0).cwiseMin(largest);
        }
    }
    quantized.elements = encode_elements(elements, type, is_normalized);
    quantized.tolerance_m = 0.5 * step_m + 1e-6 * (low.norm() + high.norm() + 1.0);
    return quantized;
}

// A GltfBuilder that compresses views and makes accessors sparse.
struct VariantBuilder {
    GltfBuilder gltf;
    std::size_t fallback_bytes = 0;  // of buffer 1, which has no data

    // Adds a view of the bytes and returns its number.
    std::size_t add_view(std::string_view bytes, std::size_t stride) {
        const std::size_t offset = gltf.binary.size();
        gltf.binary += bytes;
        gltf.binary.append((4 - gltf.binary.size() % 4) % 4, '\0');
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}};
        if (stride != 0) {
            view["byteStride"] = stride;
        }
        gltf.json["bufferViews"].push_back(view);
        return gltf.json["bufferViews"].size() - 1;
    }

    // Adds a view whose `count` elements of `stride` bytes meshoptimizer compressed.
    std::size_t add_compressed_view(std::string_view compressed, std::size_t stride,
                                    std::size_t count, const char* mode, const char* filter) {
        const std::size_t view = add_view(compressed, 0);
        nlohmann::json& json = gltf.json["bufferViews"][view];
        json["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                         {"byteOffset", json["byteOffset"]},
                                                         {"byteLength", compressed.size()},
                                                         {"byteStride", stride},
                                                         {"count", count},
                                                         {"mode", mode},
                                                         {"filter", filter}};
        json["buffer"] = 1;
        json["byteOffset"] = fallback_bytes;
        json["byteLength"] = stride * count;
        fallback_bytes += stride * count;
        return view;
    }

    std::size_t add_elements_view(const EncodedElements& elements, bool is_compressed) {
        if (!is_compressed) {
            return add_view(elements.bytes, elements.element_bytes);
        }
        std::string compressed(
            meshopt_encodeVertexBufferBound(elements.count, elements.element_bytes), '\0');
        compressed.resize(meshopt_encodeVertexBuffer(
            reinterpret_cast<unsigned char*>(compressed.data()), compressed.size(),
            elements.bytes.data(), elements.count, elements.element_bytes));
        const std::size_t view = add_compressed_view(compressed, elements.element_bytes,
                                                     elements.count, "ATTRIBUTES", "NONE");
        gltf.json["bufferViews"][view]["byteStride"] = elements.element_bytes;
        return view;
    }

    int add_accessor(std::size_t view, const EncodedElements& elements, const char* type) {
        nlohmann::json accessor = {{"bufferView", view},
                                   {"componentType", elements.component_type},
                                   {"count", elements.count},
                                   {"type", type}};
        if (elements.is_normalized) {
            accessor["normalized"] = true;
        }
        gltf.json["accessors"].push_back(accessor);
        return static_cast<int>(gltf.json["accessors"].size()) - 1;
    }

    // Stores random elements sparsely: the base holds another value there, or does not exist and is
    // zero; then every element is sparse.
    int add_sparse_accessor(const EncodedElements& elements, const char* type,
                            std::size_t components, Random& random) {
        const bool has_base = random.between(0, 1) < 0.7;
        EncodedElements base = elements;
        std::vector<std::uint16_t> indices;
        std::string values;
        for (std::size_t i = 0; i < elements.count; ++i) {
            if (!has_base || random.between(0, 1) < 0.4 || i + 1 == elements.count) {
                indices.push_back(static_cast<std::uint16_t>(i));
                // Sparse values are tightly packed.
                values +=
                    elements.element(i).substr(0, components * bytes_of(elements.component_type));
                base.bytes.replace(i * elements.element_bytes, elements.element_bytes,
                                   elements.element_bytes, '\x11');
            }
        }
        const int accessor =
            add_accessor(has_base ? add_elements_view(base, false) : 0, elements, type);
        nlohmann::json& json = gltf.json["accessors"][static_cast<std::size_t>(accessor)];
        if (!has_base) {
            json.erase("bufferView");
        }
        const std::string index_bytes(reinterpret_cast<const char*>(indices.data()),
                                      2 * indices.size());
        json["sparse"] = {
            {"count", indices.size()},
            {"indices", {{"bufferView", add_view(index_bytes, 0)}, {"componentType", 5123}}},
            {"values", {{"bufferView", add_view(values, 0)}}}};
        return accessor;
    }

    int add_elements(const EncodedElements& elements, const char* type, std::size_t components,
                     Random& random) {
        const double kind = random.between(0, 3);
        return kind < 1.0 ? add_sparse_accessor(elements, type, components, random)
                          : add_accessor(add_elements_view(elements, kind < 2.0), elements, type);
    }

    // As a plain list, or compressed as triangles or as a sequence, in 16 or 32 bits.
    int add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices,
                    Random& random) {
        const double kind = random.between(0, 3);
        if (kind < 1.0) {
            return gltf.add_indices(indices);
        }
        const bool is_list = kind < 2.0;
        std::string compressed(is_list ? meshopt_encodeIndexBufferBound(indices.size(), vertices)
                                       : meshopt_encodeIndexSequenceBound(indices.size(), vertices),
                               '\0');
        auto* const to = reinterpret_cast<unsigned char*>(compressed.data());
        compressed.resize(is_list ? meshopt_encodeIndexBuffer(to, compressed.size(), indices.data(),
                                                              indices.size())
                                  : meshopt_encodeIndexSequence(to, compressed.size(),
                                                                indices.data(), indices.size()));
        const std::size_t stride = random.between(0, 1) < 0.5 ? 2 : 4;
        const std::size_t view = add_compressed_view(compressed, stride, indices.size(),
                                                     is_list ? "TRIANGLES" : "INDICES", "NONE");
        EncodedElements shape;
        shape.count = indices.size();
        shape.component_type = stride == 2 ? 5123 : 5125;
        return add_accessor(view, shape, "SCALAR");
    }

    // Buffers last: their lengths are known.
    std::string glb() {
        gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}};
        if (fallback_bytes > 0) {
            gltf.json["buffers"].push_back(
                {{"byteLength", fallback_bytes},
                 {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
        }
        gltf.json["extensionsRequired"] = {"KHR_mesh_quantization", "EXT_meshopt_compression",
                                           "EXT_mesh_gpu_instancing"};
        return gltf.glb();
    }
};

}  // namespace handhold::test
