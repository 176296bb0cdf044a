#pragma once

#include <array>
#include <span>

#include "components/grab.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ReadPausedTrackingIo {
    std::span<const PlayerInput> inputs;                 // in: at most one a player
    const Column<HandOwner>& owner;                      // in
    const Column<ControllerToHand>& controller_to_hand;  // in
    Column<HeadTracking>& head;                          // in/out
    Column<HandTracking>& hand;                          // in/out
    Column<HandHistory>& history;                        // in/out
    // in: for hands without ControllerToHand, by side
    std::array<Pose, k_hand_count> hand_in_controller;
};

// Head and hands while the world is paused. Each player's last sample, whatever its time, gives the
// present poses. Poses that are not finite are ignored. The next frame that runs treats hands as
// lost until then: a closed hand grips where it is at that time, an opened hand lets go without a
// throw.
void read_paused_tracking(const ReadPausedTrackingIo& io);

}  // namespace handhold
