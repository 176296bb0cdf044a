#include "engine/io/gltf_skin_bindings.hpp"

#include <set>

#include "engine/io/gltf_scene.hpp"

namespace handhold::gltf {

const SkinBinding* SkinBindings::bind(const PlacedNode& placed) {
    const int skin = element(model_.nodes, placed.node).skin;
    if (skin == k_none) {
        // One slot per instance: all follow the node's joint.
        std::vector<Affine> frames;
        if (!place_instances(placed, model_, reader_, refusal_, frames)) {
            return nullptr;
        }
        rigid_.slots.clear();
        for (const Affine& frame : frames) {
            rigid_.slots.push_back({joints_.of_node.at(placed.node), frame});
        }
        return &rigid_;
    }
    if (!has_element(model_.skins, skin)) {
        refusal_.refuse_index(pointer("nodes", placed.node) + "/skin", "skin", model_.skins.size(),
                              skin);
        return nullptr;
    }
    const auto [entry, is_new] = skins_.try_emplace(skin);
    return !is_new || bind_skin(skin, entry->second) ? &entry->second : nullptr;
}

bool SkinBindings::bind_skin(int skin, SkinBinding& binding) {
    const std::vector<int>& nodes = element(model_.skins, skin).joints;
    const std::string place = pointer("skins", skin) + "/joints";
    if (!check_joint_count(nodes.size(), place, refusal_)) {
        return false;
    }
    std::set<int> seen;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto joint = joints_.of_node.find(nodes[i]);
        if (joint == joints_.of_node.end()) {
            return refusal_.refuse(
                place + "/" + std::to_string(i),
                "expected a node of the scene, found " + std::to_string(nodes[i]));
        }
        if (!seen.insert(nodes[i]).second) {
            return refusal_.refuse(place + "/" + std::to_string(i), "expected every joint once");
        }
        binding.slots.push_back({joint->second, joints_.placed_by_node.at(nodes[i])->world});
    }
    binding.is_skinned = true;
    return apply_inverse_binds(skin, binding);
}

// Multiplies the slots' maps by the inverse bind matrices, which are applied first.
bool SkinBindings::apply_inverse_binds(int skin, SkinBinding& binding) {
    const int accessor = element(model_.skins, skin).inverse_binds;
    if (accessor == k_none) {  // all matrices are identities (specification, 3.7.3.1)
        return true;
    }
    const std::string place = pointer("skins", skin) + "/inverseBindMatrices";
    std::vector<float> matrices;
    if (!reader_.read_floats(accessor, Elements::matrices, place, matrices)) {
        return false;
    }
    if (matrices.size() / 16 < binding.slots.size()) {
        return refusal_.refuse(place, "expected a matrix for each of the " +
                                          std::to_string(binding.slots.size()) + " joints, found " +
                                          std::to_string(matrices.size() / 16));
    }
    for (std::size_t i = 0; i < binding.slots.size(); ++i) {
        const Eigen::Map<const Eigen::Matrix4f> matrix(matrices.data() + 16 * i);
        const Affine inverse_bind{matrix.topLeftCorner<3, 3>().cast<double>(),
                                  matrix.topRightCorner<3, 1>().cast<double>()};
        if (!inverse_bind.linear.allFinite() || !is_finite(inverse_bind.translation)) {
            return refusal_.refuse(
                place, "expected finite matrices, found another at joint " + std::to_string(i));
        }
        binding.slots[i].to_scene = binding.slots[i].to_scene * inverse_bind;
    }
    return true;
}

}  // namespace handhold::gltf
