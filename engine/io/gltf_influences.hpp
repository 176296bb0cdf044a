#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/io/gltf_model.hpp"
#include "engine/io/gltf_primitive.hpp"

namespace handhold::gltf {

// Influence of one joint on a vertex. Private to engine/io/gltf*.
struct Influence {
    std::size_t slot = 0;  // index into SkinBinding::slots
    float weight = 0.0F;
};

// Sets `influences` to the vertex's joints with weights above 0; a joint that the file lists twice
// gets the sum. The joint of a weight 0 may be out of range: some exporters fill unused entries
// with any number. `slots`: number of slots of the skin. `place`: JSON pointer of the primitive.
// Returns false after an error.
bool collect_influences(const PrimitiveData& primitive, std::size_t vertex, std::size_t slots,
                        const std::string& place, Refusal& refusal,
                        std::vector<Influence>& influences);

}  // namespace handhold::gltf
