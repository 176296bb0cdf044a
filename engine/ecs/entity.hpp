#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/core/hash.hpp"

namespace handhold {

// A handle to an entity, 64 bits. The default is null and finds nothing. A handle to a destroyed
// entity finds nothing either, because a slot's generation increases on each reuse.
struct Entity {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;  // 0: null
    friend bool operator==(const Entity&, const Entity&) = default;
};
inline constexpr Entity k_no_entity{};
inline bool is_null(Entity entity) { return entity.generation == 0; }

// Identity of an entity across runs, machines and orders of creation. Hashes and sort orders use
// it, never the slot.
struct PersistentId {
    std::uint64_t value = 0;  // unique in a world; 0: none
    friend auto operator<=>(const PersistentId&, const PersistentId&) = default;
};
// Id of a named entity in a scene. Equal names give equal ids.
constexpr PersistentId persistent_id_from_name(std::string_view name) {
    return {hash_text(name) | 1U};
}

// Allocates slots. Reuses the slot that was freed last. The free list is state, because it decides
// the next slots.
class EntityPool {
  public:
    EntityPool() = default;
    // Restores a pool from a snapshot: every slot that is not in `free_slots` is alive. Throws
    // PreconditionError if a free slot does not exist or is listed twice, or if an alive slot has
    // generation 0.
    EntityPool(std::vector<std::uint32_t> generations, std::vector<std::uint32_t> free_slots);

    // Returns a handle that is never null. A slot's generation wraps after 2^32 - 1 uses; only then
    // can an old handle find a new entity. Throws PreconditionError if all 2^32 - 1 slots are in
    // use.
    Entity create();
    // Returns false and changes nothing for a null or stale handle.
    bool destroy(Entity entity);
    bool is_alive(Entity entity) const {
        return entity.slot < generations_.size() && entity.generation != 0 &&
               generations_[entity.slot] == entity.generation && alive_[entity.slot] != 0;
    }
    std::size_t alive_count() const { return generations_.size() - free_slots_.size(); }

    // For snapshots and hashes.
    const std::vector<std::uint32_t>& generations() const { return generations_; }
    const std::vector<std::uint32_t>& free_slots() const { return free_slots_; }

  private:
    // Per slot: the generation of its current or last entity.
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint8_t> alive_;
    std::vector<std::uint32_t> free_slots_;
};

}  // namespace handhold
