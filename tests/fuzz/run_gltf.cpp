#include <algorithm>
#include <memory>

#include "engine/collision/shape_library.hpp"
#include "engine/io/gltf.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

void run_gltf(Bytes bytes) {
    // In a folder that is not there: external buffers are never found.
    Result<GltfLevel> level = parse_gltf_level(text_of(bytes), "/nonexistent/fuzz.gltf");
    if (!level) {
        promise(!level.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    ShapeLibrary shapes;
    for (LevelPart& part : level.value().parts) {
        for (const Vec3& position : part.mesh.positions) {
            promise(
                is_finite(position) && position.cwiseAbs().maxCoeff() <= k_max_level_coordinate_m,
                "positions lie within the limit");
        }
        promise(std::is_sorted(part.color_runs.begin(), part.color_runs.end(),
                               [](const ColorRun& a, const ColorRun& b) {
                                   return a.first_triangle < b.first_triangle;
                               }),
                "colour runs ascend");
        if (!part.mesh.triangles.empty()) {
            shapes.add_mesh(std::make_shared<const Mesh>(std::move(part.mesh)));
        }
    }
}

}  // namespace handhold::fuzz
