// In place of pack_state_zstd.cpp in a program that was built without zstd.
#include <stdexcept>
#include <utility>

#include "game/net/pack_state.hpp"

namespace handhold {

bool has_packing() { return false; }

std::unique_ptr<StatePacker> StatePacker::begin(std::vector<std::byte> /*state*/) {
    throw std::runtime_error("built without zstd (libzstd-dev)");
}

std::vector<std::byte> pack_state(std::vector<std::byte> state) {
    StatePacker::begin(std::move(state));
    return {};
}

std::optional<std::vector<std::byte>> unpack_state(std::span<const std::byte> /*packed*/,
                                                   std::size_t /*most*/) {
    return std::nullopt;
}

}  // namespace handhold
