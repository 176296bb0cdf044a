#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/mesh.hpp"
#include "engine/io/result.hpp"

// Geometry out of glTF 2.0 (.gltf and .glb). Sources: Khronos glTF 2.0 specification, sections 3.5
// to 3.7 and 4.
namespace handhold {

// Triangles from `first_triangle` to the next run's look like this.
struct ColorRun {
    std::uint32_t first_triangle = 0;
    std::array<float, 3> color = {};  // linear RGB in [0, 1]
    float emissive = 0.0F;            // times the colour, added: its emissive factor and strength
    float opacity = 1.0F;             // [0, 1]; below 1 only where alphaMode is BLEND
    float gloss = 0.25F;              // [0, 1]: 1 - roughness; 0.25 where there is no material
};

// One mesh node of the file's scene.
struct LevelPart {
    Mesh mesh;  // in the frame of the scene: every node's transform is applied; named after the
                // node; its colour is that of the first run
    std::string pointer;     // of the node: "/nodes/3"
    bool synthetic = false;  // extras.synthetic of the node or its mesh: filled in by us, not by
                             // the model's author
    std::vector<ColorRun>
        color_runs;  // by base colour of the materials, ascending; not empty where triangles are
};

struct GltfLevel {
    std::vector<LevelPart> parts;  // parents before children, siblings in the file's order
    std::size_t dropped_triangles =
        0;  // without an area: a corner twice, or three corners on a line
    std::size_t skipped_primitives = 0;  // points and lines: they have no surface
};

// No coordinate of a loaded mesh is larger: there a double still resolves 2 nm.
constexpr double k_max_level_coordinate_m = 1e7;
// Vertices and triangles of a level, each: a small file can name one buffer from very many nodes.
constexpr std::size_t k_max_level_size = std::size_t{1} << 24;

// Loads the default scene (else the first one, else all root nodes). Triangles, strips and fans,
// with or without indices; a mirrored node keeps its triangles' outsides outside. Vertices that
// primitives of one node share stay shared. Images, skins, morph targets, cameras and animations
// are not read; a node with a skin is refused, since its shape depends on its joints.
//
// Refused, with the JSON pointer of the culprit and nothing loaded: any accessor, view or buffer
// that does not lie in the file, indices out of range, positions that are not finite or beyond
// k_max_level_coordinate_m, a node with two parents or in a cycle, sparse accessors, compressed or
// quantised geometry and other required extensions, external buffers outside the file's folder.
// Memory is only taken for bytes that are there.
Result<GltfLevel> load_gltf_level(const std::filesystem::path& path);
// The same for bytes in memory; `path` is for messages and for external buffers.
Result<GltfLevel> parse_gltf_level(std::string_view bytes, const std::filesystem::path& path);

}  // namespace handhold
