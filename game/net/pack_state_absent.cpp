// In place of pack_state_zstd.cpp in a program that was built without zstd.
#include <stdexcept>

#include "game/net/pack_state.hpp"

namespace handhold {

bool has_packing() { return false; }

std::vector<std::byte> pack_state(std::span<const std::byte> /*state*/) {
    throw std::runtime_error("built without zstd (libzstd-dev)");
}

std::optional<std::vector<std::byte>> unpack_state(std::span<const std::byte> /*packed*/,
                                                   std::size_t /*most*/) {
    return std::nullopt;
}

}  // namespace handhold
