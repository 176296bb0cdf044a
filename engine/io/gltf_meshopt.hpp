#pragma once

#include <string>
#include <string_view>

#include "engine/io/gltf_model.hpp"

namespace handhold::gltf {

// Decodes a view that EXT_meshopt_compression compressed. nullopt if `compressed` is malformed, or
// too short for the number of elements that the view claims. Allocates only after this check.
std::optional<std::string> decode_meshopt(const Meshopt& view, std::string_view compressed);

}  // namespace handhold::gltf
