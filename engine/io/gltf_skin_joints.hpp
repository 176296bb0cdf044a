#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_skin.hpp"
#include "engine/io/node_tree.hpp"

// The joints of a skin or of a whole figure. Private to engine/io/gltf*.
namespace handhold::gltf {

// The nodes that become joints: the joints of the only skin, or all nodes of the scene.
enum class JointSource { skin, scene };

struct SkinJoints {
    std::vector<SkinJoint> list;
    std::map<int, std::uint16_t> of_node;  // index in `list`, indexed by node
    // By node; all nodes of the scene. Points into the span that read_skin_joints was given.
    std::map<int, const PlacedNode*> placed_by_node;
};

// Reads the joints of the scene's only skin, or of all its nodes. `placed`: the nodes of the scene,
// parents first. Returns false after an error.
bool read_skin_joints(const Model& model, std::span<const PlacedNode> placed, JointSource source,
                      Refusal& refusal, SkinJoints& joints);

// Returns false, with an error at `place`, unless `count` is between 1 and k_max_skin_joints.
bool check_joint_count(std::size_t count, const std::string& place, Refusal& refusal);

}  // namespace handhold::gltf
