#include "engine/io/gltf_document.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>

#include "engine/io/gltf_buffer.hpp"
#include "engine/io/json.hpp"

namespace handhold {

namespace {

constexpr std::uint32_t k_glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t k_json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t k_bin_chunk = 0x004E4942;   // "BIN"
constexpr std::size_t k_glb_header_bytes = 12;
constexpr std::size_t k_chunk_header_bytes = 8;
constexpr std::int64_t k_max_index = INT32_MAX;
constexpr std::int64_t k_max_size = UINT32_MAX;

struct GltfSource {
    std::string_view json;
    std::string_view binary;  // empty where there is no such chunk
};

std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
    }
    return value;
}

// Takes a .glb apart; anything that does not begin like one is taken for the JSON of a .gltf.
Result<GltfSource> split_container(std::string_view bytes, const std::string& file) {
    if (bytes.size() < 4 || read_u32(bytes, 0) != k_glb_magic) {
        return GltfSource{bytes, {}};
    }
    const auto refuse = [&](std::size_t offset, std::string expected) {
        return FileError{file, "byte " + std::to_string(offset), std::move(expected)};
    };
    if (bytes.size() < k_glb_header_bytes + k_chunk_header_bytes) {
        return refuse(bytes.size(), "expected the header of a .glb, found the end of the file");
    }
    if (read_u32(bytes, 4) != 2) {
        return refuse(4, "expected version 2, found " + std::to_string(read_u32(bytes, 4)));
    }
    if (read_u32(bytes, 8) != bytes.size()) {
        return refuse(8, "expected the length of the file, " + std::to_string(bytes.size()) +
                             ", found " + std::to_string(read_u32(bytes, 8)));
    }
    GltfSource source;
    for (std::size_t at = k_glb_header_bytes, chunk = 0; at < bytes.size(); ++chunk) {
        if (bytes.size() - at < k_chunk_header_bytes) {
            return refuse(at, "expected a chunk header of 8 bytes, found " +
                                  std::to_string(bytes.size() - at));
        }
        const std::size_t length = read_u32(bytes, at);
        const std::size_t rest = bytes.size() - at - k_chunk_header_bytes;
        if (length > rest) {
            return refuse(at, "expected a chunk of at most " + std::to_string(rest) +
                                  " bytes, found a claim of " + std::to_string(length));
        }
        const std::uint32_t type = read_u32(bytes, at + 4);
        const std::string_view content = bytes.substr(at + k_chunk_header_bytes, length);
        if (chunk == 0 && type != k_json_chunk) {
            return refuse(at + 4, "expected a chunk of type JSON first");
        }
        if (chunk == 0) {
            source.json = content;
        } else if (chunk == 1 && type == k_bin_chunk) {
            source.binary = content;
        }  // others are extensions': to be ignored
        at += k_chunk_header_bytes + length;
    }
    return source;
}

void check_integers(const JsonValue& object, std::initializer_list<const char*> keys,
                    std::int64_t high) {
    for (const char* key : keys) {
        if (const JsonValue value = object[key]; value.exists()) {
            value.integer(0, high);
        }
    }
}

void check_numbers(const JsonValue& array, std::size_t count, const NumberRange& range) {
    if (!array.exists()) {
        return;
    }
    const std::vector<JsonValue> numbers = array.items();
    if (numbers.size() != count) {
        array.refuse("an array of " + std::to_string(count) + " numbers");
    }
    for (const JsonValue& number : numbers) {
        number.number(range);
    }
}

void check_synthetic(const JsonValue& object) {
    if (const JsonValue extras = object["extras"]; extras.is_object()) {
        extras["synthetic"].flag_or(false);
    }
}

// What is required is in use by something this reader must understand; the listed families only
// change how a surface looks.
void check_extensions(const JsonValue& root) {
    constexpr std::array k_harmless = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                       "KHR_lights_"};
    for (const JsonValue& extension : root["extensionsRequired"].optional_items()) {
        const std::string name = extension.text();
        bool harmless = false;
        for (const char* family : k_harmless) {
            harmless = harmless || name.rfind(family, 0) == 0;
        }
        if (!harmless) {
            extension.refuse("plain glTF 2.0 geometry without extensions");
        }
    }
}

void check_buffers(const JsonValue& root, std::size_t binary_bytes) {
    std::size_t index = 0;
    for (const JsonValue& buffer : root["buffers"].optional_items()) {
        const std::int64_t length = buffer["byteLength"].integer(1, k_max_size);
        if (const JsonValue uri = buffer["uri"]; uri.exists()) {
            uri.text();
        } else if (index != 0 || binary_bytes == 0) {
            uri.refuse("a URI: the file has no binary chunk for this buffer");
        } else if (static_cast<std::size_t>(length) > binary_bytes) {
            buffer["byteLength"].refuse("at most the " + std::to_string(binary_bytes) +
                                        " bytes of the binary chunk");
        }
        ++index;
    }
}

void check_data(const JsonValue& root) {
    constexpr std::array<std::string_view, 7> k_element_types = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                                                 "MAT2",   "MAT3", "MAT4"};
    for (const JsonValue& view : root["bufferViews"].optional_items()) {
        view["buffer"].integer(0, k_max_index);
        view["byteLength"].integer(1, k_max_size);
        check_integers(view, {"byteOffset"}, k_max_size);
        if (const JsonValue stride = view["byteStride"];
            stride.exists() && stride.integer(4, 252) % 4 != 0) {
            stride.refuse("a multiple of 4");
        }
    }
    for (const JsonValue& accessor : root["accessors"].optional_items()) {
        accessor["componentType"].integer(5120, 5126);
        accessor["count"].integer(1, k_max_size);
        const std::string type = accessor["type"].text();
        if (std::find(k_element_types.begin(), k_element_types.end(), type) ==
            k_element_types.end()) {
            accessor["type"].refuse("SCALAR, VEC2 to VEC4 or MAT2 to MAT4");
        }
        accessor["normalized"].flag_or(false);
        check_integers(accessor, {"bufferView"}, k_max_index);
        check_integers(accessor, {"byteOffset"}, k_max_size);
        if (accessor["sparse"].exists()) {
            accessor["sparse"].refuse("plain accessors: sparse ones are not supported");
        }
    }
}

void check_meshes(const JsonValue& root) {
    for (const JsonValue& mesh : root["meshes"].optional_items()) {
        check_synthetic(mesh);
        for (const JsonValue& primitive : mesh["primitives"].items()) {
            check_integers(primitive, {"indices", "material"}, k_max_index);
            check_integers(primitive, {"mode"}, 6);
            primitive["attributes"]["POSITION"].integer(0, k_max_index);
        }
    }
    for (const JsonValue& material : root["materials"].optional_items()) {
        if (const JsonValue pbr = material["pbrMetallicRoughness"]; pbr.exists()) {
            check_numbers(pbr["baseColorFactor"], 4, k_unit_interval);
            pbr["roughnessFactor"].number_or(1.0, k_unit_interval);
        }
        check_numbers(material["emissiveFactor"], 3, k_unit_interval);
        material["alphaMode"].text_or("OPAQUE");
        if (const JsonValue extensions = material["extensions"]; extensions.is_object()) {
            if (const JsonValue glow = extensions["KHR_materials_emissive_strength"];
                glow.exists()) {
                glow["emissiveStrength"].number_or(1.0, k_not_negative);
            }
        }
    }
}

void check_nodes(const JsonValue& root) {
    for (const JsonValue& node : root["nodes"].optional_items()) {
        check_integers(node, {"mesh", "skin"}, k_max_index);
        for (const JsonValue& child : node["children"].optional_items()) {
            child.integer(0, k_max_index);
        }
        const bool has_matrix = node["matrix"].exists();
        for (const char* part : {"translation", "rotation", "scale"}) {
            if (has_matrix && node[part].exists()) {
                node[part].refuse("either a matrix or translation, rotation and scale");
            }
        }
        check_numbers(node["matrix"], 16, {});
        check_numbers(node["translation"], 3, {});
        check_numbers(node["scale"], 3, {});
        node["rotation"].rotation_or(Quat::Identity());
        check_synthetic(node);
    }
    check_integers(root, {"scene"}, k_max_index);
    for (const JsonValue& scene : root["scenes"].optional_items()) {
        for (const JsonValue& node : scene["nodes"].optional_items()) {
            node.integer(0, k_max_index);
        }
    }
}

// Of what a skin hangs on; geometry alone never looks at it.
void check_skins(const JsonValue& root) {
    for (const JsonValue& mesh : root["meshes"].optional_items()) {
        for (const JsonValue& primitive : mesh["primitives"].items()) {
            check_integers(primitive["attributes"], {"NORMAL", "JOINTS_0", "JOINTS_1", "WEIGHTS_0"},
                           k_max_index);
        }
    }
    for (const JsonValue& skin : root["skins"].optional_items()) {
        check_integers(skin, {"inverseBindMatrices", "skeleton"}, k_max_index);
        for (const JsonValue& joint : skin["joints"].items()) {
            joint.integer(0, k_max_index);
        }
    }
    for (const JsonValue& node : root["nodes"].optional_items()) {
        node["name"].text_or("");
    }
}

}  // namespace

std::string join_glb(std::string json, std::string_view binary) {
    const auto pad = [](std::size_t size) { return (4 - size % 4) % 4; };
    json.append(pad(json.size()), ' ');
    const std::size_t binary_size = binary.size() + pad(binary.size());
    const std::size_t total = k_glb_header_bytes + k_chunk_header_bytes + json.size() +
                              (binary.empty() ? 0 : k_chunk_header_bytes + binary_size);
    std::string glb;
    glb.reserve(total);
    append_u32(glb, k_glb_magic);
    append_u32(glb, 2);
    append_u32(glb, static_cast<std::uint32_t>(total));
    append_u32(glb, static_cast<std::uint32_t>(json.size()));
    append_u32(glb, k_json_chunk);
    glb += json;
    if (!binary.empty()) {
        append_u32(glb, static_cast<std::uint32_t>(binary_size));
        append_u32(glb, k_bin_chunk);
        glb += binary;
        glb.append(pad(binary.size()), '\0');
    }
    return glb;
}

Result<std::string> extract_geometry_glb(std::string_view bytes, const std::string& file,
                                         GltfUse use) {
    const Result<GltfSource> source = split_container(bytes, file);
    if (!source) {
        return source.error();
    }
    const Result<JsonDocument> document = JsonDocument::parse(source.value().json, file);
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    if (const std::string version = root["asset"]["version"].text(); version.rfind("2.", 0) != 0) {
        root["asset"]["version"].refuse("version 2.x of glTF");
    }
    check_extensions(root);
    check_buffers(root, source.value().binary.size());
    check_data(root);
    check_meshes(root);
    check_nodes(root);
    if (use == GltfUse::skinned) {
        check_skins(root);
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    const char* skins = use == GltfUse::rigid ? "skins" : "images";
    return join_glb(root.dump_without({"images", "textures", "samplers", "animations", "cameras",
                                       "extensions", skins}),
                    source.value().binary);
}

}  // namespace handhold
