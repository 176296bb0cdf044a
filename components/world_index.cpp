#include "components/world_index.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"

namespace handhold {

std::size_t EntityById::home_of(std::uint64_t id) const {
    return static_cast<std::size_t>(mix64(id)) & (slots_.size() - 1);
}

std::size_t EntityById::place_of(std::uint64_t id) const {
    std::size_t at = home_of(id);
    while (slots_[at].id != 0 && slots_[at].id != id) {
        at = (at + 1) & (slots_.size() - 1);
    }
    return at;
}

Entity EntityById::find(PersistentId id) const {
    return slots_.empty() ? k_no_entity : slots_[place_of(id.value)].entity;
}

void EntityById::grow() {
    constexpr std::size_t k_first_slots = 64;
    std::vector<Slot> old(std::max(k_first_slots, 2 * slots_.size()));
    old.swap(slots_);
    for (const Slot& slot : old) {
        if (slot.id != 0) {
            slots_[place_of(slot.id)] = slot;
        }
    }
}

void EntityById::add(PersistentId id, Entity entity) {
    HH_CHECK(id.value != 0, "an id of 0 is nobody's", id.value);
    if (2 * (size_ + 1) > slots_.size()) {
        grow();
    }
    Slot& slot = slots_[place_of(id.value)];
    HH_CHECK(slot.id == 0, "the id is taken", id.value);
    slot = {id.value, entity};
    ++size_;
}

// Knuth, The Art of Computer Programming, volume 3, section 6.4, algorithm R: moves later ids of
// the probe sequence into the freed slot where probing still finds them.
void EntityById::remove(PersistentId id) {
    if (slots_.empty() || slots_[place_of(id.value)].id == 0) {
        return;
    }
    const std::size_t mask = slots_.size() - 1;
    std::size_t hole = place_of(id.value);
    for (std::size_t at = (hole + 1) & mask; slots_[at].id != 0; at = (at + 1) & mask) {
        const std::size_t from_home = (at - home_of(slots_[at].id)) & mask;
        if (from_home >= ((at - hole) & mask)) {
            slots_[hole] = slots_[at];
            hole = at;
        }
    }
    slots_[hole] = {};
    --size_;
}

void EntityById::clear() {
    slots_.clear();
    size_ = 0;
}

void JointsByBody::add(Entity joint, Entity a, Entity b) {
    for (const Entity body : {a, b}) {
        if (!is_null(body)) {
            if (body.slot >= by_slot_.size()) {
                by_slot_.resize(std::size_t{body.slot} + 1);
            }
            by_slot_[body.slot].push_back(joint);
        }
    }
    ++size_;
}

void JointsByBody::remove(Entity joint, Entity a, Entity b) {
    for (const Entity body : {a, b}) {
        if (is_null(body) || body.slot >= by_slot_.size()) {
            continue;
        }
        std::vector<Entity>& joints = by_slot_[body.slot];
        const auto found = std::ranges::find(joints, joint);
        if (found != joints.end()) {
            *found = joints.back();
            joints.pop_back();
        }
    }
    --size_;
}

std::span<const Entity> JointsByBody::of(Entity body) const {
    return body.slot < by_slot_.size() ? std::span<const Entity>(by_slot_[body.slot])
                                       : std::span<const Entity>();
}

void JointsByBody::clear() {
    by_slot_.clear();
    size_ = 0;
}

}  // namespace handhold
