#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

// Join states as they are sent: smaller, by zstd.
namespace handhold {

// False: this program was built without zstd. Nothing can be packed then.
bool has_packing();

// Packs a state a part at a time, so that no tick waits for all of it.
class StatePacker {
  public:
    virtual ~StatePacker() = default;
    // Precondition: has_packing.
    static std::unique_ptr<StatePacker> begin(std::vector<std::byte> state);
    // Packs at most so many bytes more; returns how many.
    virtual std::size_t advance(std::size_t bytes) = 0;
    virtual bool is_done() const = 0;
    // The packed state. Precondition: is_done; call once.
    virtual std::vector<std::byte> take() = 0;
};
// All at once. Precondition: has_packing.
std::vector<std::byte> pack_state(std::vector<std::byte> state);
// nullopt: these are not the bytes of a state of at most `most` bytes, or there is no zstd. Takes
// no more memory than `most` whatever the bytes say.
std::optional<std::vector<std::byte>> unpack_state(std::span<const std::byte> packed,
                                                   std::size_t most);

}  // namespace handhold
