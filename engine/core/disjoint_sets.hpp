#pragma once

#include <cstdint>
#include <vector>

namespace handhold {

// Disjoint sets of numbers, each by its root: a parent a number, a root is its own. Shortens the
// way up.
inline std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t of) {
    while (parent[of] != of) {
        parent[of] = parent[parent[of]];
        of = parent[of];
    }
    return of;
}

}  // namespace handhold
