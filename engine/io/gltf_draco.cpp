#include "engine/io/gltf_draco.hpp"

#include <algorithm>
#include <exception>
#include <memory>

#include <draco/compression/decode.h>

namespace handhold::gltf {
namespace {

// Returns k for integer types: integer n stands for max(n / k, -1) (glTF 2.0 specification,
// 3.6.2.2). Returns 0 for floats.
float normalization_of(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return 127.0F;
        case draco::DT_UINT8:
            return 255.0F;
        case draco::DT_INT16:
            return 32767.0F;
        case draco::DT_UINT16:
            return 65535.0F;
        default:
            return 0.0F;
    }
}

bool read_values(const draco::PointCloud& cloud, const DracoRequest& request,
                 std::vector<float>& values) {
    const draco::PointAttribute* const attribute =
        request.unique_id < 0
            ? nullptr
            : cloud.GetAttributeByUniqueId(static_cast<std::uint32_t>(request.unique_id));
    if (attribute == nullptr ||
        static_cast<std::size_t>(attribute->num_components()) != request.components) {
        return false;
    }
    const bool is_integer = attribute->data_type() < draco::DT_INT64;
    const float normalization =
        request.is_normalized ? normalization_of(attribute->data_type()) : 0.0F;
    const auto components = static_cast<std::int8_t>(request.components);
    std::vector<std::int32_t> integers(request.components);
    values.resize(request.components * cloud.num_points());
    for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
        const draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(i));
        float* const out = values.data() + request.components * i;
        if (index.value() >= attribute->size()) {
            return false;
        }
        if (!is_integer) {
            if (!attribute->ConvertValue<float>(index, components, out)) {
                return false;
            }
            continue;
        }
        // Reads integers, because a conversion to float would follow Draco's own normalisation flag
        // instead of the glTF accessor's.
        if (!attribute->ConvertValue<std::int32_t>(index, components, integers.data())) {
            return false;
        }
        for (std::size_t k = 0; k < request.components; ++k) {
            const auto value = static_cast<float>(integers[k]);
            out[k] = normalization > 0.0F ? std::max(value / normalization, -1.0F) : value;
        }
    }
    return true;
}

bool read_indices(const draco::Mesh& mesh, std::vector<std::uint32_t>& indices) {
    indices.reserve(3 * std::size_t{mesh.num_faces()});
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
            if (corner.value() >= mesh.num_points()) {
                return false;
            }
            indices.push_back(corner.value());
        }
    }
    return true;
}

std::optional<DracoGeometry> decode(std::string_view bytes, std::span<const DracoRequest> requests,
                                    std::size_t max_count) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok() || decoded.value() == nullptr) {
        return std::nullopt;
    }
    const draco::Mesh& mesh = *decoded.value();
    DracoGeometry geometry;
    geometry.vertices = mesh.num_points();
    if (geometry.vertices > max_count || mesh.num_faces() > max_count ||
        !read_indices(mesh, geometry.indices)) {
        return std::nullopt;
    }
    geometry.values.resize(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!read_values(mesh, requests[i], geometry.values[i])) {
            return std::nullopt;
        }
    }
    return geometry;
}

}  // namespace

bool has_draco() { return true; }

// Draco reports malformed input by a status, but a count that it cannot allocate by an exception.
std::optional<DracoGeometry> decode_draco(std::string_view bytes,
                                          std::span<const DracoRequest> requests,
                                          std::size_t max_count) {
    try {
        return decode(bytes, requests, max_count);
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace handhold::gltf
