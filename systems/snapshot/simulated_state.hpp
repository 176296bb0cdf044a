#pragma once

#include "components/world.hpp"

namespace handhold {

// A copy of a world's simulated columns (k_is_shown), its clock, its other numbers and its entity
// pool: what rollback within a window of frames needs. Far cheaper than a snapshot, and only for
// the world that it was kept from, or one with the same history: it names shapes by id. Memory is
// reused; keep and restore allocate nothing once it suffices, unless entities came or went in
// between.
class SimulatedState {
  public:
    // Call between frames only.
    void keep(const World& world);
    // Returns the world to the kept state. Shown columns stay as they are; they lose the elements
    // of entities that did not exist, and get new ones for players that are back. Caches may stay.
    // Precondition: keep was called.
    void restore(World& world) const;

    bool is_kept() const { return is_kept_; }
    // hash_simulated of the world that was kept.
    std::uint64_t hash() const;
    // The kept clock.
    const FrameClock& clock() const { return state_.clock; }

  private:
    World state_;  // copy without shown columns and caches
    bool is_kept_ = false;
};

}  // namespace handhold
