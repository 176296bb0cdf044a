#include "systems/snapshot/simulated_state.hpp"

#include <algorithm>
#include <span>
#include <type_traits>

#include "engine/core/check.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {
namespace {

void copy_simulated(const World& from, World& to) {
    to.clock = from.clock;
    to.reference_velocity_mps = from.reference_velocity_mps;
    to.gravity_mps2 = from.gravity_mps2;
    visit_simulated_members([&](const char*, auto member) { to.*member = from.*member; });
}

bool have_equal_entities(const World& a, const World& b) {
    return a.entities.generations() == b.entities.generations() &&
           a.entities.free_slots() == b.entities.free_slots() &&
           std::ranges::equal(a.persistent_id.elements(), b.persistent_id.elements()) &&
           std::ranges::equal(a.joint.owners(), b.joint.owners());
}

// Removes the elements of dead entities.
template <typename T>
void remove_dead(const EntityPool& entities, Column<T>& column) {
    for (std::size_t index = column.size(); index-- > 0;) {
        const Entity owner = column.owners()[index];
        if (!entities.is_alive(owner)) {
            column.remove(owner);
        }
    }
}

// Gives every owner that lacks an element a new one.
template <typename T>
void add_missing(std::span<const Entity> owners, Column<T>& column) {
    for (const Entity owner : owners) {
        if (!column.contains(owner)) {
            column.add(owner);
        }
    }
}

// Brings caches and shown columns in line with the world's entities.
void follow_entities(World& world) {
    world.entity_by_id.clear();
    world.joints_by_body.clear();
    sync_index(world);
    visit_column_members([&](const char*, auto member) {
        using Component = typename std::remove_cvref_t<decltype(world.*member)>::Element;
        if constexpr (k_is_shown<Component>) {
            remove_dead(world.entities, world.*member);
        }
    });
    const std::span<const Entity> players = world.player.owners();
    add_missing(players, world.render_pose);
    add_missing(players, world.arm_memory);
    add_missing(players, world.arm_estimate);
    add_missing(players, world.arm_pose);
    add_missing(players, world.spine_memory);
    add_missing(players, world.spine_pose);
    add_missing(players, world.body_clip_state);
    const std::span<const Entity> hands = world.hand_owner.owners();
    add_missing(hands, world.grip_surface);
    add_missing(hands, world.palm_offset);
    add_missing(hands, world.palm_pose);
    add_missing(hands, world.finger_pose);
}

}  // namespace

void SimulatedState::keep(const World& world) {
    copy_simulated(world, state_);
    if (!is_kept_ || state_.entities.generations() != world.entities.generations() ||
        state_.entities.free_slots() != world.entities.free_slots()) {
        state_.entities = world.entities;
    }
    is_kept_ = true;
}

std::uint64_t SimulatedState::hash() const { return hash_simulated(state_); }

void SimulatedState::restore(World& world) const {
    HH_CHECK(is_kept_, "no state is kept", 0);
    const bool has_other_entities = !have_equal_entities(state_, world);
    copy_simulated(state_, world);
    if (has_other_entities) {
        world.entities = state_.entities;
        follow_entities(world);
    }
}

}  // namespace handhold
