#pragma once

#include <vector>

#include "components/body_part.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PoseGrippableBodiesIo {
    const Column<PlayerOrigin>& origin;    // in: at the start of the frame
    const Column<HeadTracking>& head;      // in: shift_m.y() is the floor's height
    const Column<BodyMeasures>& measures;  // in: has every player
    const Column<HandOwner>& owner;        // in
    const Column<HandTracking>& hand;      // in: start_ps, edges
    const Column<Grab>& grab;              // in: from the last frame
    const Column<BodyHold>& body_hold;     // in: from the last frame
    const Column<HandPull>& pull;          // in: from the last frame
    // in: a hand that asks between two frames what it would grip if it closed, with all poses as
    // they are then; null: a frame's stage
    Entity asking;
    Column<GrippableBody>& bodies;          // out: cleared first
    std::vector<GrippablePlayer>& players;  // scratch: indexed like `origin`
};

// Poses the bodies whose arms, trunk and legs hands may grip in this frame: of players whom another
// player's hand holds by such a part, and of tracked players near the closing or pulling hands of
// another. Uses only where head and wrists are tracked (memoryless_body), so that grips do not
// depend on the shown bodies, which a frame may leave out.
void pose_grippable_bodies(const PoseGrippableBodiesIo& io, const Tuning& tuning);

}  // namespace handhold
