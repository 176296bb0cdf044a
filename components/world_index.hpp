#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace handhold {

// Finds entities by persistent id in constant time: a hash table with open addressing and linear
// probing. A cache of World::persistent_id, not state.
class EntityById {
  public:
    // Returns null if no entity has the id.
    Entity find(PersistentId id) const;
    // Precondition: the id is not in the table.
    void add(PersistentId id, Entity entity);
    void remove(PersistentId id);
    std::size_t size() const { return size_; }
    void clear();

  private:
    struct Slot {
        std::uint64_t id = 0;  // 0: free
        Entity entity;
    };
    // Slot at which probing for the id starts.
    std::size_t home_of(std::uint64_t id) const;
    // Slot of the id; if it is not in the table, the free slot at which probing ends.
    std::size_t place_of(std::uint64_t id) const;
    void grow();

    std::vector<Slot> slots_;  // size: a power of two; at most half full
    std::size_t size_ = 0;
};

// Lists the joints of each body. A cache of World::joint, not state.
class JointsByBody {
  public:
    // `a` is null for a joint to the world.
    void add(Entity joint, Entity a, Entity b);
    void remove(Entity joint, Entity a, Entity b);
    std::span<const Entity> of(Entity body) const;
    std::size_t size() const { return size_; }  // number of joints
    void clear();

  private:
    std::vector<std::vector<Entity>>
        by_slot_;  // joints of a body, indexed by the body's Entity::slot
    std::size_t size_ = 0;
};

}  // namespace handhold
