// Replaces gltf_draco.cpp if the build found no Draco.
#include "engine/io/gltf_draco.hpp"

namespace handhold::gltf {

bool has_draco() { return false; }

std::optional<DracoGeometry> decode_draco(std::string_view /*bytes*/,
                                          std::span<const DracoRequest> /*requests*/,
                                          std::size_t /*max_count*/) {
    return std::nullopt;
}

}  // namespace handhold::gltf
