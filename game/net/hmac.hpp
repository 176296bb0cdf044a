#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

// The cryptography that game/net uses; none of it is our own.
namespace handhold {

using Sha256 = std::array<std::byte, 32>;

// HMAC-SHA-256 of the text.
Sha256 hmac_sha256(std::span<const std::byte> key, std::string_view text);
// Takes the same time for equal and for different bytes. False for different lengths.
bool is_equal_in_constant_time(std::string_view a, std::string_view b);
// A number that nobody can guess.
std::uint64_t secret_number();

}  // namespace handhold
