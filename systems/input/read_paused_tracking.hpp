#pragma once

#include <array>
#include <span>

#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ReadPausedTrackingIo {
    std::span<const PlayerInput> inputs;                 // in: at most one per player
    const Column<PlayerOrigin>& origin;                  // in: scale
    const Column<HandOwner>& owner;                      // in
    const Column<ControllerToHand>& controller_to_hand;  // in
    Column<HeadTracking>& head;                          // in/out
    Column<HandTracking>& hand;                          // in/out
    Column<HandHistory>& history;                        // in/out
    // in: pose of hands without ControllerToHand, indexed by HandSide, for a scale of 1
    std::array<Pose, k_hand_count> hand_in_controller;
};

// Updates heads and hands while the world is paused. Each player's last sample, whatever its time,
// gives the present poses. Poses that are not finite are ignored. The next frame that runs treats
// hands as lost until then: a closed hand grips where it is at that time, an opened hand lets go
// without a throw.
void read_paused_tracking(const ReadPausedTrackingIo& io);

}  // namespace handhold
