#pragma once

#include <vector>

#include "engine/io/gltf.hpp"
#include "game/mesh/render_frame.hpp"

namespace handhold {

struct LevelMesh {
    Mesh mesh;
    Look look;
};

// A loaded level as meshes for the renderer: one mesh per part and kind of surface, in order of
// first use. Vertices that no triangle uses are left out. Parts and triangles keep their frame and
// winding.
std::vector<LevelMesh> make_level_meshes(const GltfLevel& level);

}  // namespace handhold
