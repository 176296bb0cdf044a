#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/core/hash.hpp"

namespace handhold {

// A handle to an entity. 64 bits; the default is null and finds nothing, and so does a handle whose
// entity was destroyed: a slot's generation rises each time it is given out again.
struct Entity {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;  // 0: null
    friend bool operator==(const Entity&, const Entity&) = default;
};
inline constexpr Entity k_no_entity{};
inline bool is_null(Entity entity) { return entity.generation == 0; }

// Who an entity is across runs, machines and orders of creation: hashes and orders follow it, never
// the slot.
struct PersistentId {
    std::uint64_t value = 0;  // unique in a world; 0 is nobody
    friend auto operator<=>(const PersistentId&, const PersistentId&) = default;
};
// The id of a thing with a name in its scene; equal names give equal ids.
constexpr PersistentId persistent_id_from_name(std::string_view name) {
    return {hash_text(name) | 1U};
}

// Gives out and takes back slots, last freed first. State: the free list decides the next slots.
class EntityPool {
  public:
    EntityPool() = default;
    // The pool that a snapshot took apart: every slot that is not free is alive. Throws
    // PreconditionError for a free slot that does not exist or stands in the list twice, and for an
    // alive one of generation 0.
    EntityPool(std::vector<std::uint32_t> generations, std::vector<std::uint32_t> free_slots);

    // Never null. A slot's generations repeat after 2^32 - 1 lives, and only then can an old handle
    // find the new entity. Throws PreconditionError where all 2^32 - 1 slots are in use.
    Entity create();
    // False for a null or stale handle, which changes nothing.
    bool destroy(Entity entity);
    bool is_alive(Entity entity) const {
        return entity.slot < generations_.size() && entity.generation != 0 &&
               generations_[entity.slot] == entity.generation && alive_[entity.slot] != 0;
    }
    std::size_t alive_count() const { return generations_.size() - free_slots_.size(); }

    // For snapshots and hashes: what there is beside the handles.
    const std::vector<std::uint32_t>& generations() const { return generations_; }
    const std::vector<std::uint32_t>& free_slots() const { return free_slots_; }

  private:
    std::vector<std::uint32_t> generations_;  // of the slot's present or last entity
    std::vector<std::uint8_t> alive_;
    std::vector<std::uint32_t> free_slots_;
};

}  // namespace handhold
