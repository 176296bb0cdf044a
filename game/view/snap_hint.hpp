#pragma once

#include <optional>

#include "components/authored_grip.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"

// Authored grips that an empty hand would snap to if it closed where it is: what pictures hint at.
// Only reads the world; nothing of it is read by the simulation.
namespace handhold {

struct SnapHint {
    Pose wrist_ws;           // of the hand in the grip
    AuthoredHand hand;       // how its fingers are then
    double nearness = 0.0;   // (0, 1]; 1: exactly in the grip
    bool is_within = false;  // the zone; else it is near it
};

// Of the grips whose zone the hand is in, or near: the one of highest priority, then the nearest to
// its middle by its own radius and angle (update_grabs goes by the palm's way), whatever sits in it
// or stands before. None for a hand that holds something.
std::optional<SnapHint> find_snap_hint(const World& world, Entity hand, const HandTuning& tuning);

}  // namespace handhold
