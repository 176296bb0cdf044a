#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/geometry/mesh.hpp"

// Reads rigid geometry from glTF 2.0 (.gltf and .glb). Source: Khronos glTF 2.0 specification,
// sections 3.5 to 3.7 and 4.
namespace handhold {

// Material of the triangles from `first_triangle` up to the next run.
struct ColorRun {
    std::uint32_t first_triangle = 0;
    std::array<float, 3> color = {};  // linear RGB in [0, 1]
    // Emitted light in multiples of `color`, >= 0: the brightest channel of the emissive factor,
    // times the emissive strength.
    float emissive = 0.0F;
    float opacity = 1.0F;  // [0, 1]; below 1 only if alphaMode is BLEND
    float gloss = 0.25F;   // [0, 1]: 1 - roughness; 0.25 without a material
};

// One mesh node of the file's scene, with all of its instances (EXT_mesh_gpu_instancing).
struct LevelPart {
    // In the scene's frame, metres. Its name is the node's; its colour is that of the first of
    // color_runs.
    Mesh mesh;
    std::string pointer;  // JSON pointer of the node: "/nodes/3"
    // extras.synthetic of the node or its mesh: true if it is not from the model's author.
    bool synthetic = false;
    std::vector<ColorRun> color_runs;  // ascending by triangle; empty if there are no triangles
};

struct GltfLevel {
    std::vector<LevelPart> parts;  // parents before children, siblings in the file's order
    // Number of triangles without area, which are left out: two equal corners, or all three on a
    // line.
    std::size_t dropped_triangles = 0;
    std::size_t skipped_primitives = 0;  // number of points, lines and primitives without positions
    // Reports what was ignored, skipped or clamped, one line each: "chair.glb: ignored morph
    // targets: 2".
    std::vector<std::string> notes = {};
};

// Largest absolute coordinate of a loaded mesh. At this distance the rounding error of a double is
// about 2 nm.
constexpr double k_max_level_coordinate_m = 1e7;
// Largest number of vertices, and of triangles, of a level. Every use of a mesh counts, because a
// small file can reference one mesh from many nodes.
constexpr std::size_t k_max_level_size = std::size_t{1} << 24;

// Loads the default scene. If there is none, loads the first scene; if there are no scenes, all
// root nodes.
//
// Reads triangle lists, strips and fans, indexed or not; sparse accessors; the extensions
// KHR_mesh_quantization, EXT_meshopt_compression, EXT_mesh_gpu_instancing, and, if the build found
// Draco, KHR_draco_mesh_compression. Triangles of a mirrored node are reversed so that their front
// stays in front. Primitives of a node that share their positions share vertices. Ignores images,
// morph targets, cameras, lights, animations and unknown extensions.
//
// Errors, with the JSON pointer of the cause: an accessor, view or buffer that is not within the
// file; indices out of range; positions that are not finite or beyond k_max_level_coordinate_m; a
// node with two parents or in a cycle; a mesh with a skin; a required extension that is not
// supported; a buffer outside the file's folder. Allocates memory in proportion to the bytes that
// the file has, not to the counts that it claims.
Result<GltfLevel> load_gltf_level(const std::filesystem::path& path);
// Reads from memory. `path` is used in messages and gives the folder of external buffers.
Result<GltfLevel> parse_gltf_level(std::string_view bytes, const std::filesystem::path& path);

}  // namespace handhold
