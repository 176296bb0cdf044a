#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

namespace handhold {

// The triangles that a search has seen: open addressing over at most `Slots` / 2 of them, so that
// a search costs no memory for each of a mesh's million. Precondition: no more are inserted.
template <std::size_t Slots>
class TriangleSet {
  public:
    // Takes the memory of `slots`, which keeps it between searches.
    explicit TriangleSet(std::vector<std::uint32_t>& slots) : slots_(slots) {
        slots_.assign(Slots, k_no_triangle);
    }
    // False where it is in already.
    bool insert(std::uint32_t triangle) {
        constexpr std::uint32_t k_golden = 2654435769U;  // Knuth's multiplicative hash
        constexpr int k_low_bits = 32 - std::countr_zero(Slots);
        const std::uint32_t hash = triangle * k_golden;
        std::size_t slot = hash >> k_low_bits;
        while (slots_[slot] != k_no_triangle) {
            if (slots_[slot] == triangle) {
                return false;
            }
            slot = (slot + 1) % Slots;
        }
        slots_[slot] = triangle;
        return true;
    }

  private:
    static_assert((Slots & (Slots - 1)) == 0, "a power of two");
    std::vector<std::uint32_t>& slots_;
};

}  // namespace handhold
