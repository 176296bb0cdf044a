#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/io/gltf_accessors.hpp"
#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_skin_joints.hpp"
#include "engine/io/node_tree.hpp"
#include "engine/math/math.hpp"

// Which joints move a mesh. Private to engine/io/gltf*.
namespace handhold::gltf {

// One entry of a skin's joint list: the joint, and the map from the mesh's bind space to the scene.
struct SkinSlot {
    std::uint16_t joint = 0;
    Affine to_scene;
};

// The slots that move a mesh: those of its skin, or those of its node.
struct SkinBinding {
    std::vector<SkinSlot> slots;
    bool is_skinned = false;
};

// Finds the binding of each node's mesh; reads every skin once.
class SkinBindings {
  public:
    // All arguments must outlive this object.
    SkinBindings(const Model& model, const SkinJoints& joints, AccessorReader& reader,
                 Refusal& refusal)
        : model_(model), joints_(joints), reader_(reader), refusal_(refusal) {}

    // The binding of the node's mesh; null after an error. Valid until the next call.
    const SkinBinding* bind(const PlacedNode& placed);

  private:
    bool bind_skin(int skin, SkinBinding& binding);
    bool apply_inverse_binds(int skin, SkinBinding& binding);

    const Model& model_;
    const SkinJoints& joints_;
    AccessorReader& reader_;
    Refusal& refusal_;
    std::map<int, SkinBinding> skins_;  // indexed by skin; only skins that a mesh uses
    SkinBinding rigid_;                 // binding of the last mesh without a skin
};

}  // namespace handhold::gltf
