#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace handhold {

// A cache over a World's columns, not state: find_by_id, add_body, add_joint and destroy cost the
// same however many entities there are. Open addressing with linear probing.
class EntityById {
  public:
    // Null if no entity has the id.
    Entity find(PersistentId id) const;
    // Precondition: the id is not there.
    void add(PersistentId id, Entity entity);
    void remove(PersistentId id);
    std::size_t size() const { return size_; }
    void clear();

  private:
    struct Slot {
        std::uint64_t id = 0;  // 0: free
        Entity entity;
    };
    std::size_t home_of(std::uint64_t id) const;
    std::size_t place_of(
        std::uint64_t id) const;  // of the id, or of the free slot that ends its run
    void grow();

    std::vector<Slot> slots_;  // a power of two, at most half full
    std::size_t size_ = 0;
};

// The joints of each body. Also a cache.
class JointsByBody {
  public:
    // `a` may be null, the world.
    void add(Entity joint, Entity a, Entity b);
    void remove(Entity joint, Entity a, Entity b);
    std::span<const Entity> of(Entity body) const;
    std::size_t size() const { return size_; }  // joints
    void clear();

  private:
    std::vector<std::vector<Entity>> by_slot_;  // joints by a body's slot
    std::size_t size_ = 0;
};

}  // namespace handhold
