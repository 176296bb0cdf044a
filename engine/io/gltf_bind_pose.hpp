#pragma once

#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/node_tree.hpp"

// The pose in which a file's meshes were bound to their joints. Private to engine/io/gltf*.
namespace handhold::gltf {

// Cosine of the largest rotation between G and a frame that may replace it (pose_as_bound).
inline constexpr double k_cos_posed = 0.5;

// Poses skeletons as they were bound. A file's nodes may have any pose, such as the first frame of
// an animation; the skins' inverse bind matrices say where the joints were when the mesh was bound:
//
//   bound_j = G inverse(B_j)     B_j: inverse bind matrix of joint j, from the mesh to the joint
//                                G: from the mesh to the scene
//                                node_j: from joint j's node to the scene, as the file has it
//
// If the nodes are in the bind pose, node_j B_j is G for every joint j; such a skin is left as it
// is. Otherwise G is node_j B_j of one joint j that is assumed to be in its bind pose: a joint that
// an earlier, at least equally large skin has too, or else the topmost joint.
//
// For the topmost joint, that G is replaced by one of three frames if one is near it: that of the
// joint's parent node, of the mesh's node, or of the scene. Near means: the same scale, a rotation
// whose cosine is above k_cos_posed, and nearly the same place for the joint. The nearest frame
// becomes G, and the topmost joint is moved too.
//
// Nodes that no skin lists keep their transform relative to their parent. A skin without usable
// matrices is left as it is.
//
// `placed`: the nodes of the scene, parents first. Returns false after an error.
bool pose_as_bound(const Model& model, AccessorReader& reader, Refusal& refusal,
                   std::vector<PlacedNode>& placed);

}  // namespace handhold::gltf
