#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/triangle_list.hpp"

namespace handhold::gltf {

// A primitive's geometry in the mesh's frame, as the file has it: coordinates may be infinite or
// NaN. Private to engine/io/gltf*.
struct PrimitiveData {
    TriangleMode mode = TriangleMode::list;
    std::size_t vertices = 0;
    std::vector<std::uint32_t> indices;  // each below `vertices`
    std::vector<float> positions;        // 3 per vertex
    std::vector<float> normals;          // 3 per vertex; empty if the primitive has none
    // Indexed by set (JOINTS_0, JOINTS_1, ...); 4 values per vertex. `joints` and `weights` have
    // equally many sets.
    std::vector<std::vector<float>> joints, weights;
};

// Attributes to read; indices are always read.
struct Wanted {
    bool positions = true;
    bool normals = false;
    bool weights = false;  // requires JOINTS_0 and WEIGHTS_0
};

// How the primitive's indices form triangles; nullopt for points and lines.
std::optional<TriangleMode> triangle_mode(const Primitive& primitive);

// True if the primitive has no triangles to read: points, lines, or no positions.
bool is_skipped(const Primitive& primitive);

// Reads a primitive, compressed by Draco or not. Errors: those of AccessorReader, attributes of
// differing counts, indices out of range, more than k_max_level_size vertices or triangles, and a
// count of indices that forms no triangle. Precondition: !is_skipped(primitive).
bool read_primitive(const Primitive& primitive, const std::string& place, const Wanted& wanted,
                    AccessorReader& reader, const Model& model, Refusal& refusal,
                    PrimitiveData& out);

// Sets `material` to the primitive's material; null if it has none.
bool find_material(const Primitive& primitive, const std::string& place, const Model& model,
                   Refusal& refusal, const Material*& material);

}  // namespace handhold::gltf
