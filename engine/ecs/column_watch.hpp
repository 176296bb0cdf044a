#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "engine/ecs/column.hpp"

namespace handhold {

// Finds the elements of a column that changed since the last update, by comparing their bytes with
// a copy. Columns do not record changes, because references allow writes to elements at any time.
// An unchanged element costs the bandwidth of a memcmp. A difference in padding counts as a change.
template <typename T>
class ColumnWatch {
    static_assert(std::is_trivially_destructible_v<T>, "elements are compared as bytes");

  public:
    // Calls visit(owner) for each element that differs from the last call, and updates the copy. If
    // the owners differ, returns false without calling visit: every element may then have changed.
    template <typename Visit>
    bool update(const Column<T>& column, Visit&& visit) {
        const std::size_t count = column.size();
        const T* const elements = column.elements().data();
        const Entity* const owners = column.owners().data();
        if (count != elements_.size() ||
            (count > 0 && std::memcmp(owners, owners_.data(), count * sizeof(Entity)) != 0)) {
            elements_.assign(column.elements().begin(), column.elements().end());
            owners_.assign(column.owners().begin(), column.owners().end());
            // Copies the bytes, because assignment leaves the padding of elements unspecified.
            copy(elements, 0, count);
            return false;
        }
        for (std::size_t begin = 0; begin < count; begin += k_block) {
            const std::size_t end = std::min(count, begin + k_block);
            if (differ(elements, begin, end)) {
                for (std::size_t index = begin; index < end; ++index) {
                    if (differ(elements, index, index + 1)) {
                        copy(elements, index, index + 1);
                        visit(owners[index]);
                    }
                }
            }
        }
        return true;
    }

  private:
    static constexpr std::size_t k_block = 32;

    const void* bytes_at(std::size_t index) const { return elements_.data() + index; }
    bool differ(const T* elements, std::size_t begin, std::size_t end) const {
        return std::memcmp(static_cast<const void*>(elements + begin), bytes_at(begin),
                           (end - begin) * sizeof(T)) != 0;
    }
    void copy(const T* elements, std::size_t begin, std::size_t end) {
        if (end > begin) {
            std::memcpy(static_cast<void*>(elements_.data() + begin),
                        static_cast<const void*>(elements + begin), (end - begin) * sizeof(T));
        }
    }

    std::vector<T> elements_;
    std::vector<Entity> owners_;
};

}  // namespace handhold
