#include "engine/io/gltf_influences.hpp"

#include <algorithm>

namespace handhold::gltf {

bool collect_influences(const PrimitiveData& primitive, std::size_t vertex, std::size_t slots,
                        const std::string& place, Refusal& refusal,
                        std::vector<Influence>& influences) {
    influences.clear();
    for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = primitive.weights[set][4 * vertex + k];
            const auto slot = static_cast<std::size_t>(primitive.joints[set][4 * vertex + k]);
            if (!(weight >= 0.0F) || weight > 1e6F) {
                return refusal.refuse(place + "/attributes/WEIGHTS_" + std::to_string(set),
                                      "expected weights in [0, 1e6], found another at vertex " +
                                          std::to_string(vertex));
            }
            if (weight == 0.0F) {
                continue;
            }
            if (slot >= slots) {
                return refusal.refuse(place + "/attributes/JOINTS_" + std::to_string(set),
                                      "expected joints below " + std::to_string(slots) +
                                          ", found " + std::to_string(slot) + " at vertex " +
                                          std::to_string(vertex));
            }
            const auto known =
                std::find_if(influences.begin(), influences.end(),
                             [&](const Influence& other) { return other.slot == slot; });
            if (known != influences.end()) {
                known->weight += weight;
            } else {
                influences.push_back({slot, weight});
            }
        }
    }
    return true;
}

}  // namespace handhold::gltf
