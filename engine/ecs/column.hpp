#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/ecs/entity.hpp"

namespace handhold {

// One component of many entities: packed elements, their owners, and a sparse map from an entity's
// slot to the index of its element. Removing an element moves the last one into the gap. Equal
// histories give equal orders. References and indices are valid until the next add or remove.
template <typename T>
class Column {
    static_assert(!std::is_same_v<T, bool>, "std::vector<bool> has no elements to refer to");

  public:
    using Element = T;

    // Returns the new element. Throws PreconditionError if the entity is null, if it already has an
    // element, or if its slot still has the element of a destroyed entity: code that destroys an
    // entity must remove its elements.
    T& add(Entity entity, T value = {}) {
        HH_CHECK(!is_null(entity), "the entity is null", entity.slot);
        if (entity.slot >= index_of_slot_.size()) {
            index_of_slot_.resize(static_cast<std::size_t>(entity.slot) + 1, k_no_index);
        }
        HH_CHECK(index_of_slot_[entity.slot] == k_no_index, "the slot has an element already",
                 entity.slot);
        if (owners_.size() % k_block_elements == 0) {
            is_run_.push_back(1);
        } else if (!follows(owners_.back(), entity)) {
            is_run_.back() = 0;
        }
        index_of_slot_[entity.slot] = static_cast<std::uint32_t>(elements_.size());
        elements_.push_back(std::move(value));
        owners_.push_back(entity);
        return elements_.back();
    }

    // Returns false and changes nothing if the entity has no element.
    bool remove(Entity entity) {
        const std::size_t index = find_index(entity);
        if (index == k_npos) {
            return false;
        }
        index_of_slot_[entity.slot] = k_no_index;
        if (index + 1 != elements_.size()) {
            elements_[index] = std::move(elements_.back());
            owners_[index] = owners_.back();
            index_of_slot_[owners_[index].slot] = static_cast<std::uint32_t>(index);
            is_run_[index / k_block_elements] = 0;
        }
        elements_.pop_back();
        owners_.pop_back();
        if (owners_.size() % k_block_elements == 0) {
            is_run_.pop_back();
        }
        return true;
    }

    static constexpr std::size_t k_npos = std::numeric_limits<std::size_t>::max();
    // The index of the entity's element. k_npos for null and stale handles, and for entities
    // without an element.
    std::size_t find_index(Entity entity) const {
        if (entity.slot >= index_of_slot_.size()) {
            return k_npos;
        }
        const std::uint32_t index = index_of_slot_[entity.slot];
        return index != k_no_index && owners_[index] == entity ? index : k_npos;
    }
    T* find(Entity entity) {
        const std::size_t index = find_index(entity);
        return index == k_npos ? nullptr : &elements_[index];
    }
    const T* find(Entity entity) const {
        const std::size_t index = find_index(entity);
        return index == k_npos ? nullptr : &elements_[index];
    }
    bool contains(Entity entity) const { return find_index(entity) != k_npos; }
    // Precondition: `element` is one of elements().
    Entity owner_of(const T& element) const {
        return owners_[static_cast<std::size_t>(&element - elements_.data())];
    }

    // The entity's element. Throws PreconditionError if it has none.
    T& at(Entity entity) {
        const std::size_t index = find_index(entity);
        HH_CHECK(index != k_npos, "no element for this entity", entity.slot);
        return elements_[index];
    }
    const T& at(Entity entity) const {
        const std::size_t index = find_index(entity);
        HH_CHECK(index != k_npos, "no element for this entity", entity.slot);
        return elements_[index];
    }

    std::size_t size() const { return elements_.size(); }
    bool empty() const { return elements_.empty(); }
    std::span<T> elements() { return elements_; }
    std::span<const T> elements() const { return elements_; }
    std::span<const Entity> owners() const { return owners_; }

    // Block b holds the elements [b * k_block_elements, ...). is_run is true only if the block's
    // owners have equal generations and consecutive slots, so that the first owner determines all.
    // It may be false for such a block after removals.
    static constexpr std::size_t k_block_elements = 256;
    bool is_run(std::size_t block) const { return is_run_[block] != 0; }

    void reserve(std::size_t count) {
        elements_.reserve(count);
        owners_.reserve(count);
    }
    void clear() {
        elements_.clear();
        owners_.clear();
        index_of_slot_.clear();
        is_run_.clear();
    }

  private:
    static constexpr std::uint32_t k_no_index = std::numeric_limits<std::uint32_t>::max();
    static bool follows(Entity before, Entity after) {
        return after.generation == before.generation && after.slot == before.slot + 1;
    }

    std::vector<T> elements_;
    std::vector<Entity> owners_;
    std::vector<std::uint32_t> index_of_slot_;
    std::vector<std::uint8_t> is_run_;  // one per block
};

}  // namespace handhold
