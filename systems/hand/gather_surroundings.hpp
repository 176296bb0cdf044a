#pragma once

#include <array>
#include <span>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/hand_surroundings.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "engine/geometry/grip_mesh_library.hpp"

namespace handhold {

struct GatherSurroundingsIo {
    const GripMeshLibrary* meshes = nullptr;        // in; null: hands are not fitted to anything
    const std::array<HandRig, k_hand_count>& rigs;  // in, by HandSide
    const FrameGraph& frame;                        // in: proxies, entities
    const Column<PersistentId>& persistent_id;      // in
    const Column<HandOwner>& owner;                 // in
    const Column<HandTracking>& hand;               // in
    const Column<Grab>& grab;                       // in
    const Column<PlayerOrigin>& origin;             // in: at the end of the frame
    const Column<HeadTracking>& head;               // in
    const Column<BodyPose>& body_pose;              // in: at the end of the frame
    const Column<Collider>& collider;               // in
    const Column<AuthoredHold>& authored_hold;      // in: stays in place until the hands are posed
    std::vector<HandSurroundings>& surroundings;    // out: one for each row of owner, in its order
};

// Where each hand is before it is fitted to anything, and what it has around it. A gripping hand is
// where its grip holds it: on its anchor, turned as it is tracked, or, where it holds an object,
// with the object. Bodies are near where the box around their mesh comes within a hand's length of
// the palm. A held head is no surface: hands on it are shown as they are.
// A held body that should have a surface and has none is counted.
void gather_surroundings(const GatherSurroundingsIo& io, StageStats& stats);

}  // namespace handhold
