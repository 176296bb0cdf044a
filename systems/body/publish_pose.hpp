#pragma once

#include <span>

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/render.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PublishPoseIo {
    std::span<const PushBack> push_backs;       // in
    const Column<PlayerOrigin>& origin;         // in
    const Column<HeadTracking>& head;           // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<Grab>& grab;                   // in
    const Column<PalmPose>& palm;               // in
    const Column<FingerPose>& fingers;          // in
    const Column<AuthoredHold>& authored_hold;  // in
    Column<RenderPose>& render;                 // out
};

// Writes the world poses of head and hands that a host draws, with palm rays, kinds of grips and
// push-backs. Gripping hands are fitted to the gripped surface.
void publish_pose(const PublishPoseIo& io, const Tuning& tuning);

}  // namespace handhold
