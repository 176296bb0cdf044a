#pragma once

#include <optional>

#include "components/authored_grip.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"

// The authored grip that an empty hand would snap to if it closed now, for rendering a hint. Only
// reads the world; the simulation reads nothing of this.
namespace handhold {

struct SnapHint {
    Pose wrist_ws;           // wrist of the hand in the grip
    AuthoredHand hand;       // finger pose in the grip
    double nearness = 0.0;   // (0, 1]; 1: exactly at the grip's pose
    bool is_within = false;  // inside the zone; else near it
};

// Considers the grips whose zone the hand is in or near. Returns the one with the highest priority,
// then the one nearest to its centre relative to its radius and angle. Ignores obstacles and
// whether the grip is taken (update_grabs also uses the palm's travel). None if the hand holds
// something.
std::optional<SnapHint> find_snap_hint(const World& world, Entity hand, const HandTuning& tuning);

}  // namespace handhold
