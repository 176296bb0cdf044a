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
// histories give equal orders. References and indices are valid until the next add or remove. In
// the names of this API, a "row" is an element or its index.
template <typename T>
class Column {
    static_assert(!std::is_same_v<T, bool>, "std::vector<bool> has no rows to refer to");

  public:
    using Row = T;

    // Returns the new element. Throws PreconditionError if the entity is null, if it already has an
    // element, or if its slot still has the element of a destroyed entity: code that destroys an
    // entity must remove its elements.
    T& add(Entity entity, T value = {}) {
        HH_CHECK(!is_null(entity), "the entity is null", entity.slot);
        if (entity.slot >= row_of_slot_.size()) {
            row_of_slot_.resize(static_cast<std::size_t>(entity.slot) + 1, k_no_row);
        }
        HH_CHECK(row_of_slot_[entity.slot] == k_no_row, "the slot has a row already", entity.slot);
        if (owners_.size() % k_block_rows == 0) {
            is_run_.push_back(1);
        } else if (!follows(owners_.back(), entity)) {
            is_run_.back() = 0;
        }
        row_of_slot_[entity.slot] = static_cast<std::uint32_t>(rows_.size());
        rows_.push_back(std::move(value));
        owners_.push_back(entity);
        return rows_.back();
    }

    // Returns false and changes nothing if the entity has no element.
    bool remove(Entity entity) {
        const std::size_t row = find_row(entity);
        if (row == k_npos) {
            return false;
        }
        row_of_slot_[entity.slot] = k_no_row;
        if (row + 1 != rows_.size()) {
            rows_[row] = std::move(rows_.back());
            owners_[row] = owners_.back();
            row_of_slot_[owners_[row].slot] = static_cast<std::uint32_t>(row);
            is_run_[row / k_block_rows] = 0;
        }
        rows_.pop_back();
        owners_.pop_back();
        if (owners_.size() % k_block_rows == 0) {
            is_run_.pop_back();
        }
        return true;
    }

    static constexpr std::size_t k_npos = std::numeric_limits<std::size_t>::max();
    // The index of the entity's element. k_npos for null and stale handles, and for entities
    // without an element.
    std::size_t find_row(Entity entity) const {
        if (entity.slot >= row_of_slot_.size()) {
            return k_npos;
        }
        const std::uint32_t row = row_of_slot_[entity.slot];
        return row != k_no_row && owners_[row] == entity ? row : k_npos;
    }
    T* find(Entity entity) {
        const std::size_t row = find_row(entity);
        return row == k_npos ? nullptr : &rows_[row];
    }
    const T* find(Entity entity) const {
        const std::size_t row = find_row(entity);
        return row == k_npos ? nullptr : &rows_[row];
    }
    bool contains(Entity entity) const { return find_row(entity) != k_npos; }
    // Precondition: `row` is an element of rows().
    Entity owner_of(const T& row) const {
        return owners_[static_cast<std::size_t>(&row - rows_.data())];
    }

    // The entity's element. Throws PreconditionError if it has none.
    T& at(Entity entity) {
        const std::size_t row = find_row(entity);
        HH_CHECK(row != k_npos, "no row for this entity", entity.slot);
        return rows_[row];
    }
    const T& at(Entity entity) const {
        const std::size_t row = find_row(entity);
        HH_CHECK(row != k_npos, "no row for this entity", entity.slot);
        return rows_[row];
    }

    std::size_t size() const { return rows_.size(); }
    bool empty() const { return rows_.empty(); }
    std::span<T> rows() { return rows_; }
    std::span<const T> rows() const { return rows_; }
    std::span<const Entity> owners() const { return owners_; }

    // Block b holds the elements [b * k_block_rows, ...). is_run is true only if the block's owners
    // have equal generations and consecutive slots, so that the first owner determines all. It may
    // be false for such a block after removals.
    static constexpr std::size_t k_block_rows = 256;
    bool is_run(std::size_t block) const { return is_run_[block] != 0; }

    void reserve(std::size_t count) {
        rows_.reserve(count);
        owners_.reserve(count);
    }
    void clear() {
        rows_.clear();
        owners_.clear();
        row_of_slot_.clear();
        is_run_.clear();
    }

  private:
    static constexpr std::uint32_t k_no_row = std::numeric_limits<std::uint32_t>::max();
    static bool follows(Entity before, Entity after) {
        return after.generation == before.generation && after.slot == before.slot + 1;
    }

    std::vector<T> rows_;
    std::vector<Entity> owners_;
    std::vector<std::uint32_t> row_of_slot_;
    std::vector<std::uint8_t> is_run_;  // one per block
};

}  // namespace handhold
