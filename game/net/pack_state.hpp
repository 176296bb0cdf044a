#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// Join states as they are sent: smaller, by zstd.
namespace handhold {

// False: this program was built without zstd. pack_state must not be called then.
bool has_packing();
// Precondition: has_packing.
std::vector<std::byte> pack_state(std::span<const std::byte> state);
// nullopt: these are not the bytes of a state of at most `most` bytes, or there is no zstd. Takes
// no more memory than `most` whatever the bytes say.
std::optional<std::vector<std::byte>> unpack_state(std::span<const std::byte> packed,
                                                   std::size_t most);

}  // namespace handhold
