#pragma once

#include <cstddef>

#include <handhold/handhold.hpp>

namespace handhold {

// Bytes of a player and of their hands in all columns, including owners and indices.
std::size_t state_bytes(const hh::World& world, hh::Player player);

}  // namespace handhold
