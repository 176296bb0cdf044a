#pragma once

#include <vector>

#include "engine/io/gltf.hpp"

namespace handhold {

// A loaded level as the renderer takes it: one mesh for each part and colour, in order of first
// use, without the vertices that it does not need. Parts and triangles keep their frame and
// winding.
std::vector<Mesh> make_level_meshes(const GltfLevel& level);

}  // namespace handhold
