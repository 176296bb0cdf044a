#pragma once

#include <string>
#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/node_tree.hpp"

namespace handhold::gltf {

// Lists the nodes of the default scene, parents before children. If there is no default scene: the
// nodes of the first scene; if there are no scenes: all nodes. Returns false after an error.
// Private to engine/io/gltf*.
bool place_scene(const Model& model, Refusal& refusal, std::vector<PlacedNode>& placed);

// Sets the transforms of a node's mesh into the scene: one, or one per instance
// (EXT_mesh_gpu_instancing). Errors: more than 2^20 instances of a node, and transforms that are
// not finite.
bool place_instances(const PlacedNode& placed, const Model& model, AccessorReader& reader,
                     Refusal& refusal, std::vector<Affine>& frames);

// A line with a note about a file: "chair.glb: ignored morph targets: 2".
std::string note_line(const std::string& file, const std::string& note);

}  // namespace handhold::gltf
