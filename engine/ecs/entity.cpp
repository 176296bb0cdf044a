#include "engine/ecs/entity.hpp"

#include <limits>
#include <utility>

#include "engine/core/check.hpp"

namespace handhold {

EntityPool::EntityPool(std::vector<std::uint32_t> generations,
                       std::vector<std::uint32_t> free_slots)
    : generations_(std::move(generations)),
      alive_(generations_.size(), 1),
      free_slots_(std::move(free_slots)) {
    for (const std::uint32_t slot : free_slots_) {
        HH_CHECK(slot < alive_.size(), "no such free slot", slot);
        HH_CHECK(alive_[slot] != 0, "the slot is free twice", slot);
        alive_[slot] = 0;
    }
    for (std::size_t slot = 0; slot < alive_.size(); ++slot) {
        HH_CHECK(alive_[slot] == 0 || generations_[slot] != 0, "an alive slot has no generation",
                 slot);
    }
}

Entity EntityPool::create() {
    if (free_slots_.empty()) {
        HH_CHECK(generations_.size() < std::numeric_limits<std::uint32_t>::max(), "no slot left",
                 generations_.size());
        generations_.push_back(1);
        alive_.push_back(1);
        return {static_cast<std::uint32_t>(generations_.size() - 1), 1};
    }
    const std::uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    alive_[slot] = 1;
    // Skips 0 when the generation wraps around, because generation 0 means null.
    if (++generations_[slot] == 0) {
        generations_[slot] = 1;
    }
    return {slot, generations_[slot]};
}

bool EntityPool::destroy(Entity entity) {
    if (!is_alive(entity)) {
        return false;
    }
    alive_[entity.slot] = 0;
    free_slots_.push_back(entity.slot);
    return true;
}

}  // namespace handhold
