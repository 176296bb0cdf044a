#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace handhold::gltf {

// True if this build decodes KHR_draco_mesh_compression.
bool has_draco();

struct DracoRequest {
    int unique_id = 0;  // Draco's id of the attribute
    std::size_t components = 3;
    bool is_normalized = false;  // integers stand for [0, 1] or [-1, 1]
};

struct DracoGeometry {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> indices;  // three per triangle, each below `vertices`
    // One array per DracoRequest, in the same order; each has `components` values per vertex.
    std::vector<std::vector<float>> values;
};

// Decodes a mesh. Returns nullopt if the bytes are malformed, lack a requested attribute, or hold
// more vertices or triangles than `max_count`. Always returns nullopt in a build without Draco.
std::optional<DracoGeometry> decode_draco(std::string_view bytes,
                                          std::span<const DracoRequest> requests,
                                          std::size_t max_count);

}  // namespace handhold::gltf
