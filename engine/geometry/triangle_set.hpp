#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

namespace handhold {

// Hash set of visited triangles with open addressing. Its size does not depend on the mesh.
// Precondition: at most Slots / 2 insertions.
template <std::size_t Slots>
class TriangleSet {
  public:
    // Uses `slots` as its memory, so that the memory can be reused for the next search.
    explicit TriangleSet(std::vector<std::uint32_t>& slots) : slots_(slots) {
        slots_.assign(Slots, k_no_triangle);
    }
    // Returns false if the triangle is already in the set.
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
