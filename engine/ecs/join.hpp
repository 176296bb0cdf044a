#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "engine/ecs/column.hpp"

namespace handhold {

// Looks in `other` for the owners of the driver's elements [begin, begin + length), in the same
// order and without gaps. Returns the index of the first of them in `other`, or k_npos. The range
// is a block or the last part of one. The result is exact: two runs (Column::is_run) are equal if
// their first owners are; other blocks are compared owner by owner.
template <typename Driver, typename Other>
std::size_t find_equal_block(const Driver& driver, std::size_t begin, std::size_t length,
                             const Other& other) {
    static_assert(std::has_unique_object_representations_v<Entity>, "owners are compared as bytes");
    const Entity* const owners = driver.owners().data() + begin;
    const std::size_t index = other.find_index(owners[0]);
    if (index == Other::k_npos || other.size() - index < length) {
        return Other::k_npos;
    }
    const std::size_t block = begin / Driver::k_block_elements;
    if (index == begin && driver.is_run(block) && other.is_run(block)) {
        return index;
    }
    const bool equal =
        std::memcmp(other.owners().data() + index, owners, length * sizeof(Entity)) == 0;
    return equal ? index : Other::k_npos;
}

// Calls visit(entity, element of the driver, elements of the others...) for every entity that is in
// all columns, in the order of the driver. Columns may be const. No column may gain or lose
// elements during the call.
//
// Columns that are filled together have equal orders. If the owners of a block of the driver appear
// in the same sequence in every other column, the block is walked as plain arrays. Otherwise every
// entity is looked up. Orders are compared on each call, never cached.
template <typename Driver, typename Visit, typename... Others>
void join(Driver& driver, Visit&& visit, Others&... others) {
    const std::size_t count = driver.size();
    const Entity* const owners = driver.owners().data();
    const auto driver_elements = driver.elements();
    for (std::size_t begin = 0; begin < count; begin += Driver::k_block_elements) {
        const std::size_t end = std::min(count, begin + Driver::k_block_elements);
        const auto walk_arrays = [&](auto*... other_elements) {
            for (std::size_t index = begin; index < end; ++index) {
                visit(owners[index], driver_elements[index], other_elements[index - begin]...);
            }
        };
        const auto look_up = [&] {
            for (std::size_t index = begin; index < end; ++index) {
                const auto visit_if_complete = [&](auto*... found) {
                    if ((found && ...)) {
                        visit(owners[index], driver_elements[index], *found...);
                    }
                };
                visit_if_complete(others.find(owners[index])...);
            }
        };
        const auto walk_or_look_up = [&](auto... first_index) {
            if (((first_index != Driver::k_npos) && ...)) {
                walk_arrays((others.elements().data() + first_index)...);
            } else {
                look_up();
            }
        };
        walk_or_look_up(find_equal_block(driver, begin, end - begin, others)...);
    }
}

}  // namespace handhold
