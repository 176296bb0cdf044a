#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

// Writes small glTF files for tests, byte by byte after the specification: an oracle that shares no
// code with the reader.
namespace handhold::test {

inline void append_le32(std::string& bytes, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>((value >> shift) & 0xFF);
    }
}

struct GltfBuilder {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::string binary;

    // Appends bytes as a buffer view and an accessor over all of it; returns the accessor's number.
    int add_accessor(std::string_view bytes, int component_type, const char* type,
                     std::size_t count) {
        const std::size_t offset = binary.size();
        binary += bytes;
        binary.append((4 - binary.size() % 4) % 4, '\0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
        json["buffers"] = {{{"byteLength", binary.size()}}};
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    int add_positions(const std::vector<std::array<float, 3>>& positions) {
        std::string bytes(positions.size() * 12, '\0');
        std::memcpy(bytes.data(), positions.data(), bytes.size());
        return add_accessor(bytes, 5126, "VEC3", positions.size());
    }

    template <typename T>
    int add_indices(const std::vector<T>& indices) {
        std::string bytes(indices.size() * sizeof(T), '\0');
        std::memcpy(bytes.data(), indices.data(), bytes.size());
        const int component_type = sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : 5125;
        return add_accessor(bytes, component_type, "SCALAR", indices.size());
    }

    // A mesh of one primitive; indices -1: none.
    int add_mesh(int positions, int indices, int mode = 4) {
        nlohmann::json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
        if (indices != -1) {
            primitive["indices"] = indices;
        }
        json["meshes"].push_back({{"primitives", {primitive}}});
        return static_cast<int>(json["meshes"].size()) - 1;
    }

    std::string glb() const { return glb_of(json.dump()); }

    std::string glb_of(std::string text) const {
        text.append((4 - text.size() % 4) % 4, ' ');
        std::string bytes = "glTF";
        append_le32(bytes, 2);
        append_le32(bytes, 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
        append_le32(bytes, text.size());
        bytes += "JSON" + text;
        if (!binary.empty()) {
            append_le32(bytes, binary.size());
            bytes += std::string("BIN\0", 4) + binary;
        }
        return bytes;
    }
};

// One node with the triangle (0,0,0), (1,0,0), (0,1,0).
inline GltfBuilder triangle_file() {
    GltfBuilder builder;
    const int positions = builder.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const int indices = builder.add_indices<std::uint16_t>({0, 1, 2});
    builder.json["nodes"] = {{{"mesh", builder.add_mesh(positions, indices)}, {"name", "tri"}}};
    builder.json["scenes"] = {{{"nodes", {0}}}};
    builder.json["scene"] = 0;
    return builder;
}

// Declares the positions to be compressed, which they are not.
inline nlohmann::json& make_compressed(GltfBuilder& b) {
    nlohmann::json& meshopt = b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
    meshopt = {{"buffer", 0},
               {"byteLength", 36},
               {"byteStride", 12},
               {"count", 3},
               {"mode", "ATTRIBUTES"}};
    return meshopt;
}

}  // namespace handhold::test
