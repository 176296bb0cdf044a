#pragma once

#include <cstdint>
#include <vector>

namespace handhold {

// Union-find lookup with path halving. `parent` maps each element to its parent; a root is its own
// parent.
inline std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t element) {
    while (parent[element] != element) {
        parent[element] = parent[parent[element]];
        element = parent[element];
    }
    return element;
}

}  // namespace handhold
