#pragma once

#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/node_tree.hpp"

// The pose in which a file's meshes were bound to their joints. Private to engine/io/gltf*.
namespace handhold::gltf {

inline constexpr double k_cos_posed = 0.5;

// Poses skeletons as they were bound. A file's nodes have any pose, such as the first frame of an
// animation; the skins' inverse bind matrices say where the joints were when the mesh was bound:
//
//   bound_j = G inverse(B_j)     B_j: inverse bind matrix of joint j, from the mesh to the joint
//                                G: from the mesh to the scene; node_j B_j in a bound file
//
// G is that of the skin's topmost joint, unless the frame of the mesh's node, of the node above
// that joint or of the scene has the same scale, is turned against it by an angle whose cosine is
// above k_cos_posed and puts the joint near where it is: then the topmost joint is posed too, and G
// is the nearest of these frames. Nodes that no skin lists keep their place in the node above them.
// A skin whose joints all agree on G is left as it is, and so is one without usable matrices.
//
// `placed`: the nodes of the scene, parents first. Returns false after an error.
bool pose_as_bound(const Model& model, AccessorReader& reader, Refusal& refusal,
                   std::vector<PlacedNode>& placed);

}  // namespace handhold::gltf
