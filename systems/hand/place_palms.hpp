#pragma once

#include "components/body.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PlacePalmsIo {
    const Column<PlayerOrigin>& origin;  // in
    const Column<HeadTracking>& head;    // in
    const Column<HandOwner>& owner;      // in
    const Column<HandTracking>& hand;    // in
    const Column<Grab>& grab;            // in
    const Column<BodyPose>& body_pose;   // in
    Column<PalmPose>& palm;              // out
};

// Where each hand is shown: as tracked, or on its anchor while it grips.
void place_palms(const PlacePalmsIo& io);

}  // namespace handhold
