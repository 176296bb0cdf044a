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
    std::array<Pose, k_hand_count> hand_in_controller;   // in: of hands without a joint, by side
};

// Head and hands while the world stands still: each player's last sample, whatever its time, is the
// pose now. Poses that are not finite are ignored. For the next frame that runs, hands count as
// lost until then: closed ones grip where they are by then, opened ones let go without a throw.
void read_paused_tracking(const ReadPausedTrackingIo& io);

}  // namespace handhold
