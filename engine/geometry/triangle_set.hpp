#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

namespace handhold {

// The triangles that a search has seen: open addressing over at most `k_slots` / 2 of them, so that
// a search costs no memory for each of a mesh's million. Precondition: no more are inserted.
template <std::size_t k_slots>
class TriangleSet {
  public:
    // Takes the memory of `slots`, which keeps it between searches.
    explicit TriangleSet(std::vector<std::uint32_t>& slots) : slots_(slots) {
        slots_.assign(k_slots, k_no_triangle);
    }
    // False where it is in already.
    bool insert(std::uint32_t triangle) {
        constexpr std::uint32_t k_golden = 2654435769U;  // Knuth's multiplicative hash
        constexpr int k_low_bits = 32 - std::countr_zero(k_slots);
        const std::uint32_t hash = triangle * k_golden;
        std::size_t slot = hash >> k_low_bits;
        while (slots_[slot] != k_no_triangle) {
            if (slots_[slot] == triangle) {
                return false;
            }
            slot = (slot + 1) % k_slots;
        }
        slots_[slot] = triangle;
        return true;
    }

  private:
    static_assert((k_slots & (k_slots - 1)) == 0, "a power of two");
    std::vector<std::uint32_t>& slots_;
};

}  // namespace handhold
