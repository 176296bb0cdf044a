#pragma once

#include <optional>

#include "components/tuning.hpp"
#include "components/world.hpp"

// The authored grip that an empty hand would snap to if it closed now, for rendering a hint. The
// simulation does not use it.
namespace handhold {

struct SnapHint {
    Pose wrist_ws;           // wrist of the hand in the grip
    AuthoredHand hand;       // finger pose in the grip
    double nearness = 0.0;   // (0, 1]; 1: exactly at the grip's pose; 0.5: at the zone's boundary
    bool is_within = false;  // inside the zone; else near it
};

// Considers the grips whose zone the hand is in or near. Prefers zones that the hand is in, then
// the higher priority, then the larger nearness. nullopt if there is no such grip or if the hand
// already grips. Unlike update_grabs, ignores obstacles, the palm's travel, and whether the grip is
// taken.
std::optional<SnapHint> find_snap_hint(const World& world, Entity hand, const HandTuning& tuning);

}  // namespace handhold
