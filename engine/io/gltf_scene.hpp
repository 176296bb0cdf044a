#pragma once

#include <string>
#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/node_tree.hpp"

namespace handhold::gltf {

// The nodes of the default scene, parents before children. Without a default scene it is the first
// scene; without scenes, all nodes. Private to engine/io/gltf*.
bool place_scene(const Model& model, Refusal& refusal, std::vector<PlacedNode>& placed);

// The frames into the scene in which a node's mesh stands: one, or one per instance
// (EXT_mesh_gpu_instancing). Refuses more than 2^20 instances of a node and frames that are not
// finite.
bool place_instances(const PlacedNode& placed, const Model& model, AccessorReader& reader,
                     Refusal& refusal, std::vector<Affine>& frames);

// "note" as a line of its own: "chair.glb: ignored morph targets: 2".
std::string note_line(const std::string& file, const std::string& note);

}  // namespace handhold::gltf
