// Buffers, views and accessors of a glTF document (specification, 5.1, 5.11 and 5.10).
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "engine/io/gltf_json.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/json.hpp"

namespace handhold::gltf {
namespace {

void parse_buffers(const JsonValue& root, Model& model) {
    for (const JsonValue& value : root["buffers"].optional_items()) {
        Buffer buffer;
        buffer.bytes = read_size(value["byteLength"], 1);
        if (const JsonValue meshopt = extension_of(value, k_meshopt_extension); meshopt.exists()) {
            buffer.is_fallback = meshopt["fallback"].flag_or(false);
        }
        const std::size_t available = model.buffers.empty() ? model.binary.size() : 0;
        if (const JsonValue uri = value["uri"]; uri.exists()) {
            buffer.uri = uri.text();
        } else if (!buffer.is_fallback && available == 0) {
            uri.refuse("a URI: the file has no binary chunk for this buffer");
        } else if (!buffer.is_fallback && buffer.bytes > available) {
            value["byteLength"].refuse("at most the " + std::to_string(available) +
                                       " bytes of the binary chunk");
        }
        model.buffers.push_back(std::move(buffer));
    }
}

Meshopt parse_meshopt(const JsonValue& value) {
    Meshopt meshopt;
    meshopt.buffer = read_index(value["buffer"]);
    meshopt.offset = read_offset(value["byteOffset"]);
    meshopt.bytes = read_size(value["byteLength"], 1);
    meshopt.stride = static_cast<std::uint64_t>(value["byteStride"].integer(2, 256));
    meshopt.count = read_size(value["count"], 1);
    const std::string mode = value["mode"].text();
    if (mode == "TRIANGLES") {
        meshopt.mode = Meshopt::Mode::triangles;
    } else if (mode == "INDICES") {
        meshopt.mode = Meshopt::Mode::indices;
    } else if (mode != "ATTRIBUTES") {
        value["mode"].refuse("ATTRIBUTES, TRIANGLES or INDICES");
    }
    const std::string filter = value["filter"].text_or("NONE");
    if (filter == "OCTAHEDRAL") {
        meshopt.filter = Meshopt::Filter::octahedral;
    } else if (filter == "QUATERNION") {
        meshopt.filter = Meshopt::Filter::quaternion;
    } else if (filter == "EXPONENTIAL") {
        meshopt.filter = Meshopt::Filter::exponential;
    } else if (filter != "NONE") {
        value["filter"].refuse("NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
    }
    return meshopt;
}

void parse_views(const JsonValue& root, Model& model) {
    for (const JsonValue& value : root["bufferViews"].optional_items()) {
        BufferView view;
        view.buffer = static_cast<int>(value["buffer"].integer(0, k_max_index));
        view.offset = read_offset(value["byteOffset"]);
        view.bytes = read_size(value["byteLength"], 1);
        if (const JsonValue stride = value["byteStride"]; stride.exists()) {
            view.stride = static_cast<std::uint64_t>(stride.integer(4, 252));
            if (view.stride % 4 != 0) {
                stride.refuse("a multiple of 4");
            }
        }
        if (const JsonValue meshopt = extension_of(value, k_meshopt_extension); meshopt.exists()) {
            view.meshopt = parse_meshopt(meshopt);
        }
        model.views.push_back(view);
    }
}

ComponentType parse_component_type(const JsonValue& value) {
    const std::int64_t type = value.integer(5120, 5126);
    if (type == 5124) {
        value.refuse("5120 to 5123, 5125 or 5126");
        return ComponentType::float32;
    }
    return static_cast<ComponentType>(type);
}

SparseElements parse_sparse(const JsonValue& value) {
    SparseElements sparse;
    sparse.count = read_size(value["count"], 1);
    const JsonValue indices = value["indices"];
    sparse.indices_view = static_cast<int>(indices["bufferView"].integer(0, k_max_index));
    sparse.indices_offset = read_offset(indices["byteOffset"]);
    sparse.indices_type = parse_component_type(indices["componentType"]);
    const JsonValue values = value["values"];
    sparse.values_view = static_cast<int>(values["bufferView"].integer(0, k_max_index));
    sparse.values_offset = read_offset(values["byteOffset"]);
    return sparse;
}

void parse_accessors(const JsonValue& root, Model& model) {
    struct ElementType {
        std::string_view name;
        std::size_t components;
    };
    constexpr std::array<ElementType, 7> k_types = {{{"SCALAR", 1},
                                                     {"VEC2", 2},
                                                     {"VEC3", 3},
                                                     {"VEC4", 4},
                                                     {"MAT2", 4},
                                                     {"MAT3", 9},
                                                     {"MAT4", 16}}};
    for (const JsonValue& value : root["accessors"].optional_items()) {
        Accessor accessor;
        accessor.view = read_index(value["bufferView"]);
        accessor.offset = read_offset(value["byteOffset"]);
        accessor.count = read_size(value["count"], 1);
        accessor.component_type = parse_component_type(value["componentType"]);
        accessor.is_normalized = value["normalized"].flag_or(false);
        const std::string type = value["type"].text();
        const auto* const found = std::find_if(
            k_types.begin(), k_types.end(), [&](const ElementType& t) { return t.name == type; });
        if (found == k_types.end()) {
            value["type"].refuse("SCALAR, VEC2 to VEC4 or MAT2 to MAT4");
        } else {
            accessor.components = found->components;
            accessor.is_matrix = type.front() == 'M';
        }
        if (const JsonValue sparse = value["sparse"]; sparse.exists()) {
            accessor.sparse = parse_sparse(sparse);
        }
        model.accessors.push_back(accessor);
    }
}

}  // namespace

void parse_data_layout(const JsonValue& root, Model& model) {
    parse_buffers(root, model);
    parse_views(root, model);
    parse_accessors(root, model);
}

}  // namespace handhold::gltf
